// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/symbol_shape.h>

#include <algorithm>
#include <cmath>

#include <oblique/draw/picture/text_width.h>

namespace oblique::draw::schematic {
namespace {

using Eigen::Vector2d;

constexpr double kPitch = 2 * kLayoutGrid;  // between pins

double on_grid(double length) {
  return std::ceil(length / kLayoutGrid) * kLayoutGrid;
}

/// A name in lines of a readable width, broken after '_', '.' or ' '.
std::vector<std::string> lines_of(const std::string& name) {
  constexpr double kWidest = 84;
  std::vector<std::string> lines{""};
  std::string word;
  const auto put = [&] {
    if (!lines.back().empty() && text_width(lines.back() + word, kCaption) > kWidest) lines.emplace_back();
    lines.back() += word;
    word.clear();
  };
  for (const char c : name) {
    word += c;
    if (c == '_' || c == '.' || c == ' ') put();
  }
  put();
  return lines;
}

/// The number of an amplifier or another element, as a plan of a machine gives it: a short label.
bool is_number(const std::string& label) {
  constexpr std::size_t kLongest = 4;
  return !label.empty() && label.size() <= kLongest &&
         std::any_of(label.begin(), label.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
         std::all_of(label.begin(), label.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

std::optional<double> parameter(const Block& block, std::string_view name) {
  const auto index = block.definition->find_parameter(name);
  return index ? std::optional(block.parameters[*index]) : std::nullopt;
}

/// "cos": the function that the block's equation calls; the block's type where it is more than a call.
std::string function_text(const diagram::BlockDefinition& definition) {
  if (!definition.behaviours.empty() && !definition.behaviours.back().equations.empty()) {
    const text::Expression& e = definition.behaviours.back().equations.front().expression;
    if (e.kind == text::Expression::Kind::call) {
      for (const text::FunctionInfo& info : text::functions()) {
        if (info.function == e.function) return std::string(info.name);
      }
    }
  }
  return definition.name;
}

/// What stands in a circle or a box of a block whose value is its first parameter.
std::string value_text(const Block& block, std::string_view symbol) {
  const bool has_number = !block.parameters.empty() && !block.definition->parameters.front().formula &&
                          !block.definition->parameters.front().points;
  if (symbol == "gain") return has_number ? "× " + number_text(block.parameters.front()) : "";
  return has_number ? number_text(block.parameters.front()) : "";
}

void choose(const Block& block, SymbolStyle style, Shape& shape) {
  const diagram::BlockDefinition& definition = *block.definition;
  const SymbolEntry* const entry = find_symbol(definition.symbol);
  const bool plain_ports = definition.outputs.size() == 1 && block.outputs.size() == 1;
  if (entry == nullptr || entry->classic == Form::ports || !plain_ports) {
    shape.form = Form::ports;
    shape.text = definition.name;
    if (entry == nullptr) return;
    shape.icon = entry->icon;
    shape.sign = style == SymbolStyle::classic ? entry->classic_text : entry->din_text;
    return;
  }
  const bool classic = style == SymbolStyle::classic;
  shape.form = classic ? entry->classic : Form::box;
  shape.text = classic ? entry->classic_text : entry->din_text;
  if (shape.form == Form::box && entry->classic == Form::box) shape.icon = entry->icon;
  if (definition.symbol == "function") shape.text = function_text(definition);
  if (definition.symbol == "potentiometer" || definition.symbol == "gain" || definition.symbol == "constant")
    shape.text = value_text(block, definition.symbol);
  shape.inverts = block.inverts || definition.symbol == "inverter";
  if (entry->classic == Form::integrator) {
    if (const auto initial = parameter(block, "initial")) shape.initial = number_text(*initial);
    const auto rate = parameter(block, "rate");
    if (rate && *rate != 1) shape.text += (shape.text.empty() ? "" : " ") + number_text(*rate);
  }
}

void write_caption(const Block& block, Shape& shape) {
  if (!is_number(block.label)) {
    shape.caption = lines_of(block.label.empty() ? block.name : block.label);
    return;
  }
  const bool is_amplifier = shape.form == Form::triangle || shape.form == Form::open_amplifier;
  shape.caption = lines_of(is_amplifier ? block.name : block.label + " " + block.name);
  if (is_amplifier) shape.text = block.label;
}

/// How wide what is written left of the body is.
double beside_width(const Block& block) {
  double weights = 0, constants = 0;
  for (const Input& input : block.inputs) {
    const std::string text = lead_text(block, input);
    if (!text.empty()) weights = std::max(weights, text_width(text, kSmall) + 6);
    if (!input.constant.empty()) constants = std::max(constants, text_width(input.constant, kSmall) + 14);
  }
  return weights + constants;
}

double widest(const std::vector<std::string>& texts, double size) {
  double width = 0;
  for (const std::string& text : texts) width = std::max(width, text_width(text, size));
  return width;
}

/// Room on the right for what is written at the outputs.
double records_width(const Block& block) {
  const double text = widest(block.records, kSmall);
  return text == 0 ? 0 : text + kRecordIndent + 2 * kBubble + 4;
}

/// How long a triangle of this height must be to hold a text at its back.
double triangle_length(double text, double size, double height) {
  return (text + 6) / (1 - (size + 2) / height);
}

Vector2d body_size(const Block& block, const Shape& shape) {
  const double pins = static_cast<double>(std::max(block.inputs.size(), block.outputs.size()));
  const double tall = std::max(3 * kPitch, kPitch * (pins + 1));
  const double text = text_width(shape.text, text_size(shape));
  const double length = triangle_length(text, text_size(shape), tall);
  switch (shape.form) {
    case Form::triangle:
      return {on_grid(std::max(std::clamp(0.9 * tall, 44.0, 64.0), length)), tall};
    case Form::open_amplifier:
      return {on_grid(std::max(std::clamp(0.9 * tall, 52.0, 64.0), length)), tall};
    case Form::integrator:
      return {on_grid(kBar + std::max(std::clamp(0.9 * tall, 44.0, 64.0), length)), tall};
    case Form::circle:
      return {3 * kPitch, 3 * kPitch};
    case Form::ports: {
      std::vector<std::string> inputs, outputs;
      for (const Input& input : block.inputs) inputs.push_back(port_sign(block, input.port).text);
      for (const std::string& output : block.outputs) outputs.push_back(port_sign(block, output).text);
      const double between = (shape.icon.empty() && shape.sign.empty() ? 28 : 32 + 2 * kIcon);
      const double heading = text_width(shape.text, kSmall, true);
      return {on_grid(std::max(widest(inputs, kSmall) + widest(outputs, kSmall) + between, heading + 16)),
              kPitch * (pins + 1) + kPitch};
    }
    case Form::terminal:
      return {on_grid(text_width(block.name, kSmall) + 14), kPitch * std::max(pins, 1.0)};
    case Form::box:
      break;
  }
  return {on_grid(std::max(40.0, text + 12)), tall};
}

std::vector<double> pins_of(std::size_t n, const Shape& shape) {
  std::vector<double> pins;
  const double middle = shape.corner.y() + shape.body.y() / 2 + (shape.form == Form::ports ? kLayoutGrid : 0);
  const double first =
      std::round((middle - kPitch * (static_cast<double>(n) - 1) / 2) / kLayoutGrid) * kLayoutGrid;
  for (std::size_t k = 0; k < n; ++k) pins.push_back(first + kPitch * static_cast<double>(k));
  return pins;
}

/// The middle of the text inside.
double text_centre(const Shape& shape) {
  const double w = shape.body.x(), half = text_width(shape.text, text_size(shape)) / 2;
  switch (shape.form) {
    case Form::triangle:
      return std::max(0.36 * w, half + 3);
    case Form::open_amplifier:
      return std::max(0.4 * w, half + 3);
    case Form::integrator:
      return kBar + std::max(0.33 * (w - kBar), half + 3);
    default:
      return w / 2;
  }
}

}  // namespace

double text_size(const Shape& shape) {
  if (shape.form == Form::circle || shape.form == Form::integrator) return kSmall;
  return shape.text == "×" || shape.text == "÷" ? 18 : kText;
}

std::string lead_text(const Block& block, const Input& input) {
  if (block.kind != Block::Kind::block) return {};
  std::string text = input.weight == 1 ? "" : number_text(input.weight);
  const SymbolEntry* const entry = find_symbol(block.definition->symbol);
  const bool named_inside = entry == nullptr || entry->classic == Form::ports || block.outputs.size() > 1;
  const bool first_of_sums = input.port_index == 0 && block.definition->inputs.front().sum;
  if (named_inside || entry->inputs_alike || block.definition->inputs.size() == 1 || first_of_sums)
    return text;
  return text + (text.empty() ? "" : " ") + input.port;
}

Shape shape_of(const Block& block, SymbolStyle style) {
  Shape shape;
  if (block.kind != Block::Kind::block) {
    shape.form = Form::terminal;
    shape.text = block.name;
    shape.body = body_size(block, shape);
    shape.node.size = shape.body;
    shape.node.rank = block.kind == Block::Kind::input ? LayoutRank::first : LayoutRank::last;
    shape.node.inputs.assign(block.inputs.size(), kLayoutGrid);
    shape.node.outputs.assign(block.outputs.size(), kLayoutGrid);
    return shape;
  }
  choose(block, style, shape);
  write_caption(block, shape);
  shape.body = body_size(block, shape);
  shape.text_centre = text_centre(shape);
  double left = 6;
  left = std::max(left, beside_width(block) + 4);
  const double caption = widest(shape.caption, kCaption) / 2 - shape.body.x() / 2;
  left = on_grid(std::max(left, caption + 2));
  const double right = on_grid(std::max({8.0, caption + 2, records_width(block)}));
  const double above = shape.initial.empty() ? 0 : kPitch;
  shape.corner = {left, above};
  const double below = on_grid(2 + kCaption * 1.15 * static_cast<double>(shape.caption.size()));
  shape.node.size = {on_grid(left + shape.body.x() + right), on_grid(above + shape.body.y()) + below};
  shape.node.inputs = pins_of(block.inputs.size(), shape);
  shape.node.outputs = pins_of(block.outputs.size(), shape);
  return shape;
}

Shape frame_shape(const Block& block, const Vector2d& inside, const std::vector<double>& inputs,
                  const std::vector<double>& outputs) {
  Shape shape;
  shape.form = Form::ports;
  shape.text = block.definition->name;
  double left = kLayoutGrid;
  left = std::max(left, beside_width(block) + 4);
  shape.corner = {on_grid(left), 0};
  const std::string title = block.label.empty() ? block.name : block.label;
  shape.caption = {title};
  const double heading = text_width(title, kText) * 1.1 + text_width(shape.text, kSmall) + 40;
  shape.body = {std::max(on_grid(inside.x()), on_grid(heading)),
                on_grid(inside.y()) + kFrameTop + kFrameMargin};
  const double right = on_grid(std::max(kLayoutGrid, records_width(block)));
  shape.node.size = {shape.corner.x() + shape.body.x() + right, shape.body.y()};
  for (const double y : inputs) shape.node.inputs.push_back(y + kFrameTop);
  for (const double y : outputs) shape.node.outputs.push_back(y + kFrameTop);
  return shape;
}

}  // namespace oblique::draw::schematic
