// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/symbols.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/draw/picture/text_width.h>

namespace oblique::draw::schematic {
namespace {

using Eigen::Vector2d;

std::string tooltip_of(const Block& block, const std::string& path) {
  if (block.definition == nullptr) return path;
  std::string text = fmt::format("{}: {}", path, block.definition->title);
  for (std::size_t k = 0; k < block.parameters.size(); ++k) {
    if (block.given[k] && !block.definition->parameters[k].points && !block.definition->parameters[k].formula)
      text += fmt::format("\n{} = {:.6g}", block.definition->parameters[k].name, block.parameters[k]);
  }
  return text;
}

class Artist {
 public:
  Artist(const Block& block, const Shape& shape, std::string path, const Vector2d& at, Picture& picture)
      : block_(block),
        shape_(shape),
        path_(std::move(path)),
        at_(at),
        picture_(picture),
        pen_{block.loop ? loop_ink(*block.loop) : Ink::line, 1.6, {}},
        corner_(at + shape.corner) {}

  void draw() {
    if (shape_.form == Form::terminal) {
      draw_terminal();
      return;
    }
    draw_body();
    draw_leads();
    draw_texts();
  }

 private:
  Vector2d body(double x, double y) const { return corner_ + Vector2d(x, y); }
  double width() const { return shape_.body.x(); }
  double height() const { return shape_.body.y(); }

  void put(Mark mark) { picture_.marks.push_back(std::move(mark)); }
  void put_wire(Mark mark, const std::string& signal) {
    mark.signals = signal;
    put(std::move(mark));
  }
  void write(const Vector2d& at, const std::string& text, Anchor anchor, double size) {
    if (!text.empty()) put(label_mark(at, text, anchor, size));
  }

  void add_body(Mark mark) {
    mark.fill = Ink::paper;
    mark.id = "block-" + path_;
    mark.element = path_;
    for (const std::string& signal : block_.reads) mark.signals += (mark.signals.empty() ? "" : " ") + signal;
    mark.tooltip = tooltip_of(block_, path_);
    put(std::move(mark));
  }

  void draw_terminal() {
    const bool input = block_.kind == Block::Kind::input;
    const double y = at_.y() + kLayoutGrid;
    const double edge = input ? at_.x() : at_.x() + width();
    write({input ? edge + 4 : edge - 4, y + 3.5}, shape_.text, input ? Anchor::start : Anchor::end, kSmall);
    const double end = input ? at_.x() + width() : at_.x();
    const double text = text_width(shape_.text, kSmall) + 8;
    put_wire(line_mark({input ? edge + text : edge - text, y}, {end, y}, {Ink::line, 1.2, {}}),
             input ? block_.reads.front() : block_.inputs.front().reads);
  }

  void draw_body() {
    const double w = width(), h = height();
    switch (shape_.form) {
      case Form::triangle:
        add_body(polyline_mark({body(0, 0), body(w, h / 2), body(0, h)}, pen_, true));
        break;
      case Form::integrator:
        add_body(polyline_mark({body(kBar, 0), body(w, h / 2), body(kBar, h)}, pen_, true));
        put({Box{corner_, {kBar, h}}, pen_, Ink::paper});
        break;
      case Form::open_amplifier:
        add_body(open_amplifier());
        break;
      case Form::circle:
        add_body(disc_mark(body(w / 2, h / 2), w / 2, Ink::paper, pen_));
        break;
      default: {
        Mark mark = box_mark(corner_, shape_.body, Ink::paper, pen_);
        std::get<Box>(mark.shape).rounding = shape_.form == Form::ports ? 4 : 0;
        add_body(std::move(mark));
      }
    }
  }

  /// A triangle with a round back.
  Mark open_amplifier() const {
    const double w = width(), h = height();
    Outline outline;
    outline.segments = {{Segment::Kind::move, body(8, 0)},
                        {Segment::Kind::line, body(w, h / 2)},
                        {Segment::Kind::line, body(8, h)},
                        {Segment::Kind::cubic, body(8, 0), body(-3, 0.7 * h), body(-3, 0.3 * h)},
                        {Segment::Kind::close}};
    return {std::move(outline), pen_};
  }

  /// x of the body's left edge at a height, from the body's corner.
  double edge_at(double y) const {
    if (shape_.form == Form::open_amplifier) {
      const double t = y / height();
      return 8 - 33 * t * (1 - t);
    }
    if (shape_.form == Form::circle) {
      const double r = width() / 2, d = y - r;
      return r - std::sqrt(std::max(0.0, r * r - d * d));
    }
    return 0;
  }

  void draw_leads() {
    const Pen wire{Ink::line, 1.2, {}};
    double widest = 0;  // constants stand one below the other
    for (const Input& input : block_.inputs) {
      if (!input.constant.empty()) widest = std::max(widest, text_width(lead_text(block_, input), kSmall));
    }
    for (std::size_t k = 0; k < block_.inputs.size(); ++k) {
      const Input& input = block_.inputs[k];
      const double y = shape_.node.inputs[k];
      const double edge = shape_.corner.x() + edge_at(y - shape_.corner.y());
      write(at_ + Vector2d(shape_.corner.x() - 3, y - 3), lead_text(block_, input), Anchor::end, kSmall);
      if (input.constant.empty()) {
        put_wire(line_mark(at_ + Vector2d(0, y), at_ + Vector2d(edge, y), lead_pen(input)), input.reads);
        continue;
      }
      const double x = shape_.corner.x() - 3 - widest - 8;
      put_wire(line_mark(at_ + Vector2d(x, y), at_ + Vector2d(edge, y), wire), input.reads);
      put_wire(disc_mark(at_ + Vector2d(x, y), 2, Ink::paper, wire), input.reads);
      write(at_ + Vector2d(x - 5, y + 3.5), input.constant, Anchor::end, kSmall);
    }
    for (std::size_t k = 0; k < block_.outputs.size(); ++k) draw_output(k);
  }

  void draw_output(std::size_t k) {
    const double y = shape_.node.outputs[k];
    const double right = shape_.corner.x() + width();
    const bool inverts =
        shape_.inverts || (block_.inside.empty() && port_sign(block_, block_.outputs[k]).inverted);
    const double bubble = inverts ? 2 * kBubble : 0;
    const bool is_used = block_.wired[k] || (k < block_.records.size() && !block_.records[k].empty());
    const double end = is_used ? shape_.node.size.x() : right + kLayoutGrid;
    put_wire(line_mark(at_ + Vector2d(right + bubble, y), at_ + Vector2d(end, y), output_pen()),
             block_.reads[k]);
    if (inverts) put(disc_mark(at_ + Vector2d(right + kBubble, y), kBubble, Ink::paper, {pen_.ink, 1.2, {}}));
    if (k >= block_.records.size() || block_.records[k].empty()) return;
    const Vector2d tip = at_ + Vector2d(right + bubble + kRecordIndent - 4, y);
    Mark arrow =
        polyline_mark({tip, tip - Vector2d(7, 3.5), tip - Vector2d(7, -3.5)}, {Ink::none, 0, {}}, true);
    arrow.fill = output_pen().ink;
    arrow.id = "record-" + path_ + (block_.outputs.size() > 1 ? "." + block_.outputs[k] : "");
    put_wire(std::move(arrow), block_.reads[k]);
    write(tip + Vector2d(4, -3), block_.records[k], Anchor::start, kSmall);
  }

  static Pen lead_pen(const Input& input) {
    return {input.loop ? loop_ink(*input.loop) : Ink::line, 1.2, {}};
  }
  Pen output_pen() const { return {block_.loop ? pen_.ink : Ink::line, 1.2, {}}; }

  void draw_texts() {
    const double w = width(), h = height();
    if (shape_.form == Form::ports) {
      draw_port_names();
    } else {
      const double size = text_size(shape_);
      write(body(shape_.text_centre, h / 2 + 0.36 * size), shape_.text, Anchor::middle, size);
      draw_icon(body(w / 2, h / 2));
    }
    if (!shape_.initial.empty()) {
      const double x = shape_.form == Form::integrator ? kBar / 2 : w / 2;
      put(line_mark(body(x, -4), body(x, 0), {Ink::line, 1.2, {}}));
      write(body(x, -6), shape_.initial, Anchor::middle, kSmall);
    }
    for (std::size_t k = 0; k < shape_.caption.size() && block_.inside.empty(); ++k)
      write(body(w / 2, h + 1 + kCaption * (1 + 1.15 * static_cast<double>(k))), shape_.caption[k],
            Anchor::middle, kCaption);
  }

  void draw_port_names() {
    if (!block_.inside.empty()) {
      put(label_mark(body(10, 18), shape_.caption.front(), Anchor::start, kText));
      std::get<Label>(picture_.marks.back().shape).bold = true;
      const double x = 18 + text_width(shape_.caption.front(), kText, true);
      write(body(x, 18), shape_.text, Anchor::start, kSmall);
      return;
    }
    write(body(width() / 2, 13), shape_.text, Anchor::middle, kSmall);
    std::get<Label>(picture_.marks.back().shape).bold = true;
    double left = 0, right = 0;  // widths of the names
    for (std::size_t k = 0; k < block_.inputs.size(); ++k) {
      const PortSign sign = port_sign(block_, block_.inputs[k].port);
      const Vector2d pin = at_ + Vector2d(shape_.corner.x(), shape_.node.inputs[k]);
      if (sign.edge)
        put(polyline_mark({pin - Vector2d(0, 4), pin + Vector2d(7, 0), pin + Vector2d(0, 4)}, thin()));
      write(pin + Vector2d(sign.edge ? 10 : 5, 3.5), sign.text, Anchor::start, kSmall);
      left = std::max(left, text_width(sign.text, kSmall) + (sign.edge ? 5 : 0));
    }
    for (std::size_t k = 0; k < block_.outputs.size(); ++k) {
      const std::string text = port_sign(block_, block_.outputs[k]).text;
      write(at_ + Vector2d(shape_.corner.x() + width() - 5, shape_.node.outputs[k] + 3.5), text, Anchor::end,
            kSmall);
      right = std::max(right, text_width(text, kSmall));
    }
    const Vector2d middle = body((width() + left - right) / 2, height() / 2 + kLayoutGrid);
    draw_icon(middle);
    write(middle + Vector2d(0, 0.36 * kText), shape_.sign, Anchor::middle, kText);
  }

  Pen thin() const { return {pen_.ink, 1.2, {}}; }

  void draw_icon(const Vector2d& middle) {
    for (const auto& line : icon_lines(shape_.icon)) {
      std::vector<Vector2d> points;
      points.reserve(line.size());
      for (const Vector2d& p : line) points.emplace_back(middle + kIcon * Vector2d(p.x(), -p.y()));
      put(polyline_mark(points, {pen_.ink, 1.4, {}}));
    }
  }

  const Block& block_;
  const Shape& shape_;
  std::string path_;
  Vector2d at_;
  Picture& picture_;
  Pen pen_;
  Vector2d corner_;
};

}  // namespace

void draw_symbol(const Block& block, const Shape& shape, const std::string& path, const Vector2d& at,
                 Picture& picture) {
  Artist(block, shape, path, at, picture).draw();
}

Ink loop_ink(std::size_t loop) {
  return kAccents[loop % std::size(kAccents)];
}

}  // namespace oblique::draw::schematic
