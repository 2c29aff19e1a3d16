// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/panel.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <oblique/draw/schematic/schematic.h>
#include <oblique/draw/schematic/sheet.h>
#include <oblique/draw/schematic/sheet_drawing.h>
#include <oblique/draw/schematic/sheet_places.h>
#include <oblique/draw/schematic/symbols.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using schematic::Block;
using schematic::Input;
using schematic::Schematic;
using schematic::Shape;
using schematic::Sheet;

constexpr double kPanelMargin = 24;

/// A diagram of which every block has a type that is known: where one is not, a box stands for it, with the
/// inputs that the file wires.
struct KnownTypes {
  diagram::Diagram diagram;
  diagram::BlockLibrary library;
};
std::unique_ptr<KnownTypes> with_known_types(const diagram::Diagram& diagram,
                                             const diagram::BlockLibrary& library) {
  const auto is_known = [&](const diagram::BlockInstance& block) {
    return library.find(block.type) != nullptr;
  };
  if (std::all_of(diagram.blocks.begin(), diagram.blocks.end(), is_known)) return nullptr;
  std::map<std::string, diagram::BlockDefinition> missing;
  auto known = std::make_unique<KnownTypes>(KnownTypes{diagram, library});
  for (diagram::BlockInstance& block : known->diagram.blocks) {
    if (is_known(block)) continue;
    if (block.type.empty()) block.type = "?";
    diagram::BlockDefinition& definition = missing[block.type];
    definition.name = definition.title = block.type;
    if (definition.outputs.empty()) definition.outputs.push_back({"out", {}, {}, {}});
    for (const diagram::WrittenWire& wire : diagram::wires_of(block.settings, nullptr)) {
      if (!definition.find_input(wire.key)) definition.inputs.push_back({wire.key, true, 0.0, {}, {}});
    }
  }
  for (auto& [type, definition] : missing) known->library.add(std::move(definition));
  return known;
}

/// Which of the drawn inputs a wire is: the one whose name stands in the wire's text, or none.
std::optional<std::size_t> input_of(const diagram::WrittenWire& wire, const Block& block,
                                    std::vector<bool>& taken) {
  for (std::size_t k = 0; k < block.inputs.size(); ++k) {
    const Input& input = block.inputs[k];
    if (taken[k] || input.open || input.source.empty() || input.source != wire.signal) continue;
    if (input.position.line != wire.position.line || input.position.column < wire.position.column) continue;
    const auto reach = static_cast<int>(wire.text.size()) + 2;  // with the quotes
    if (input.position.column > wire.position.column + reach) continue;
    taken[k] = true;
    return k;
  }
  return std::nullopt;
}

/// Straight lines where the router gave up, so that nothing is hidden.
void draw_lost_nets(const Sheet& sheet, const Vector2d& at, PatchPanel& panel) {
  for (const std::size_t n : sheet.layout.lost) {
    const RoutedNet& net = sheet.layout.nets[n];
    const auto pin = [&](std::size_t block, double x, double y) {
      return Vector2d(at + sheet.layout.corners[block] + Vector2d(x, y));
    };
    const LayoutNode& from = sheet.shapes[net.from].node;
    const auto& blocks = sheet.schematic->blocks;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (std::size_t k = 0; k < blocks[b].inputs.size(); ++k) {
        const auto& signal = blocks[b].inputs[k].signal;
        if (!signal || signal->block != net.from || signal->output != net.output) continue;
        panel.picture.marks.push_back(line_mark(pin(net.from, from.size.x(), from.outputs[net.output]),
                                                pin(b, 0, sheet.shapes[b].node.inputs[k]),
                                                {Ink::vermilion, 1.2, {4, 3}}));
      }
    }
    panel.lost.push_back(blocks[net.from].name);
  }
}

Picture picture_of(const Sheet& sheet) {
  Picture picture;
  picture.width = sheet.layout.size.x() + 2 * kPanelMargin;
  picture.height = sheet.layout.size.y() + 2 * kPanelMargin;
  schematic::draw_sheet(sheet, "", {kPanelMargin, kPanelMargin}, picture);
  return picture;
}

void locate(const Block& block, const Shape& shape, const Vector2d& corner, PatchPanelBlock& located) {
  const Vector2d body = corner + shape.corner;
  located.body = Box{body, shape.body, 0};
  located.whole = Box{corner, shape.node.size, 0};
  std::vector<bool> taken(block.inputs.size());
  for (PatchPanelWire& wire : located.wires) {
    const auto input = input_of(wire.written, block, taken);
    if (!input) continue;
    wire.weight = block.inputs[*input].weight;
    wire.at = Vector2d(body.x(), corner.y() + shape.node.inputs[*input]);
  }
  for (std::size_t k = 0; k < block.inputs.size(); ++k) {
    if (block.inputs[k].open)
      located.open_inputs.push_back({block.inputs[k].port, {body.x(), corner.y() + shape.node.inputs[k]}});
  }
  for (std::size_t k = 0; k < block.outputs.size(); ++k) {
    const bool is_only = block.definition->outputs.size() == 1 && k == 0;
    located.outputs.push_back({is_only ? block.name : block.name + "." + block.outputs[k],
                               {body.x() + shape.body.x(), corner.y() + shape.node.outputs[k]}});
  }
}

}  // namespace

PatchPanel draw_panel(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                      const std::string& held, SymbolStyle symbols) {
  const std::unique_ptr<KnownTypes> known = with_known_types(diagram, library);
  const Schematic schematic =
      schematic::sketch_schematic(known ? known->diagram : diagram, known ? known->library : library);
  const Sheet sheet = schematic::sketch_sheet(schematic, symbols, held);
  const Vector2d at(kPanelMargin, kPanelMargin);
  PatchPanel panel;
  panel.picture = picture_of(sheet);
  panel.picture.title = diagram.title;
  panel.origin = at + sheet.origin;
  panel.moved = sheet.moved;
  draw_lost_nets(sheet, at, panel);
  const std::vector<diagram::BlockPlace> places = schematic::places_of(sheet);
  for (const diagram::BlockInstance& instance : diagram.blocks) {
    PatchPanelBlock located;
    located.instance = &instance;
    located.definition = library.find(instance.type);
    const auto given =
        std::find_if(diagram.layout.begin(), diagram.layout.end(),
                     [&](const diagram::BlockPlace& place) { return place.name == instance.name; });
    located.is_placed = given != diagram.layout.end();
    for (diagram::WrittenWire& wire : diagram::wires_of(instance.settings, located.definition))
      located.wires.push_back({std::move(wire), 1, {}});
    for (std::size_t b = 0; b < schematic.blocks.size(); ++b) {
      if (schematic.blocks[b].name != instance.name) continue;
      locate(schematic.blocks[b], sheet.shapes[b], at + sheet.layout.corners[b], located);
      const bool is_drawn_there =
          located.is_placed && std::none_of(panel.moved.begin(), panel.moved.end(),
                                            [&](const auto& place) { return place.name == instance.name; });
      located.x = is_drawn_there ? given->x : places[b].x;
      located.y = is_drawn_there ? given->y : places[b].y;
    }
    panel.blocks.push_back(std::move(located));
  }
  return panel;
}

Picture draw_inside(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                    const std::string& path, SymbolStyle symbols) {
  const auto depth = 1 + static_cast<int>(std::count(path.begin(), path.end(), '.'));
  Schematic schematic = schematic::make_schematic(diagram, library, depth);
  std::string_view rest = path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('.'), rest.size());
    const auto block = std::find_if(schematic.blocks.begin(), schematic.blocks.end(), [&](const Block& b) {
      return b.kind == Block::Kind::block && b.name == rest.substr(0, end);
    });
    if (block == schematic.blocks.end() || block->inside.empty()) {
      throw diagram::DiagramError(
          text::Diagnostic{{diagram.file, {}},
                           fmt::format("there is no composite '{}' to be opened", path),
                           "the path of a block that is put together of others",
                           {}});
    }
    Schematic inside = std::move(block->inside.front());
    schematic = std::move(inside);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  Picture picture = picture_of(schematic::make_sheet(schematic, symbols));
  picture.title = path;
  return picture;
}

Picture draw_symbol_of(const diagram::BlockDefinition& definition, SymbolStyle symbols) {
  Block block;
  block.definition = &definition;
  for (const diagram::ParameterDefinition& parameter : definition.parameters)
    block.parameters.push_back(parameter.default_value);
  block.given.resize(definition.parameters.size());
  for (std::size_t k = 0; k < definition.inputs.size(); ++k) {
    Input input;
    input.port = definition.inputs[k].name;
    input.port_index = k;
    block.inputs.push_back(std::move(input));
  }
  for (const diagram::OutputPort& output : definition.outputs) block.outputs.push_back(output.name);
  block.wired.assign(block.outputs.size(), true);
  block.reads.resize(block.outputs.size());
  const Shape shape = schematic::shape_of(block, symbols);
  Picture picture;
  picture.title = definition.title;
  constexpr double kAround = 4;
  picture.width = shape.node.size.x() + 2 * kAround;
  picture.height = shape.corner.y() + shape.body.y() + 2 * kAround;
  schematic::draw_symbol(block, shape, {}, {kAround, kAround}, picture);
  for (Mark& mark : picture.marks) mark.id.clear();
  return picture;
}

}  // namespace oblique::draw
