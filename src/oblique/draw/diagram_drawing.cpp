// SPDX-License-Identifier: MIT
#include <oblique/draw/diagram_drawing.h>

#include <algorithm>

#include <oblique/draw/schematic.h>
#include <oblique/draw/symbols.h>

namespace oblique {
namespace {

using Eigen::Vector2d;
using schematic::Block;
using schematic::Schematic;
using schematic::Shape;

constexpr int kLoopWeight = 3;  // servo loops stay together
constexpr double kMargin = 24;

/// A schematic with its layout, and those of its open composites.
struct Sheet {
  const Schematic* schematic = nullptr;
  std::vector<Shape> shapes;  ///< of each block
  std::vector<Sheet> inside;  ///< of each block; without layout where it is not open
  DiagramLayout layout;
};

LayoutGraph graph_of(const Schematic& schematic, const std::vector<Shape>& shapes) {
  LayoutGraph graph;
  for (const Shape& shape : shapes) graph.nodes.push_back(shape.node);
  for (std::size_t b = 0; b < schematic.blocks.size(); ++b) {
    const auto& inputs = schematic.blocks[b].inputs;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (!inputs[k].signal) continue;
      const std::size_t from = inputs[k].signal->block;
      graph.wires.push_back({from, inputs[k].signal->output, b, k, inputs[k].in_loop ? kLoopWeight : 1});
    }
  }
  return graph;
}

/// The frame of an open composite: its pins are where the terminals stand inside.
Shape open_shape(const Block& block, const Sheet& inside) {
  std::vector<double> inputs, outputs;
  const auto& blocks = inside.schematic->blocks;
  for (const schematic::Input& input : block.inputs) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (blocks[b].kind == Block::Kind::input && blocks[b].name == input.port)
        inputs.push_back(inside.layout.corners[b].y() + inside.shapes[b].node.outputs[0]);
    }
  }
  for (const std::string& output : block.outputs) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (blocks[b].kind == Block::Kind::output && blocks[b].name == output)
        outputs.push_back(inside.layout.corners[b].y() + inside.shapes[b].node.inputs[0]);
    }
  }
  return schematic::frame_shape(block, inside.layout.size, inputs, outputs);
}

Sheet make_sheet(const Schematic& schematic, SymbolStyle style) {
  Sheet sheet;
  sheet.schematic = &schematic;
  for (const Block& block : schematic.blocks) {
    sheet.inside.emplace_back();
    if (!block.inside.empty()) sheet.inside.back() = make_sheet(block.inside.front(), style);
    sheet.shapes.push_back(block.inside.empty() ? schematic::shape_of(block, style)
                                                : open_shape(block, sheet.inside.back()));
  }
  sheet.layout = lay_out(graph_of(schematic, sheet.shapes));
  return sheet;
}

/// The colour of a net: that of the servo loop that it is a part of.
Ink net_ink(const Schematic& schematic, std::size_t from, std::size_t output) {
  for (const Block& block : schematic.blocks) {
    for (const schematic::Input& input : block.inputs) {
      if (input.loop && input.signal->block == from && input.signal->output == output)
        return schematic::loop_ink(*input.loop);
    }
  }
  return Ink::line;
}

void draw_net(const Sheet& sheet, const RoutedNet& net, const std::string& prefix, const Vector2d& at,
              Picture& picture) {
  const Block& block = sheet.schematic->blocks[net.from];
  const Ink ink = net_ink(*sheet.schematic, net.from, net.output);
  Outline outline;
  for (const WirePiece& piece : net.pieces) {
    outline.segments.push_back({Segment::Kind::move, at + piece.from});
    outline.segments.push_back({Segment::Kind::line, at + piece.to});
  }
  Mark mark{std::move(outline), {ink, 1.2, {}}};
  mark.id = "net-" + prefix + block.name + "." + block.outputs[net.output];
  mark.tooltip = prefix + block.name + (block.outputs.size() > 1 ? "." + block.outputs[net.output] : "");
  picture.marks.push_back(std::move(mark));
  for (const Vector2d& junction : net.junctions)
    picture.marks.push_back(disc_mark(at + junction, 2.5, ink, {Ink::none, 0, {}}));
}

void draw_sheet(const Sheet& sheet, const std::string& prefix, const Vector2d& at, Picture& picture) {
  for (const RoutedNet& net : sheet.layout.nets) draw_net(sheet, net, prefix, at, picture);
  for (std::size_t b = 0; b < sheet.shapes.size(); ++b) {
    const Block& block = sheet.schematic->blocks[b];
    const Vector2d corner = at + sheet.layout.corners[b];
    schematic::draw_symbol(block, sheet.shapes[b], prefix + block.name, corner, picture);
    if (block.inside.empty()) continue;
    draw_sheet(sheet.inside[b], prefix + block.name + ".",
               corner + sheet.shapes[b].corner + Vector2d(0, schematic::kFrameTop), picture);
  }
}

LayoutQuality quality_of(const Sheet& sheet) {
  LayoutQuality quality = sheet.layout.quality;
  for (const Sheet& inside : sheet.inside) {
    if (inside.schematic == nullptr) continue;
    const LayoutQuality inner = quality_of(inside);
    quality.crossings += inner.crossings;
    quality.bends += inner.bends;
    quality.feedbacks += inner.feedbacks;
    quality.wire_length += inner.wire_length;
  }
  return quality;
}

}  // namespace

Picture draw_diagram(const Diagram& diagram, const BlockLibrary& library, const DiagramDrawing& options) {
  const Schematic schematic = schematic::make_schematic(diagram, library, options.depth);
  const Sheet sheet = make_sheet(schematic, options.symbols);
  constexpr double kTitleSize = 14;
  const double heading = diagram.title.empty() ? 0 : 32;
  Picture picture;
  picture.title = diagram.title;
  const double title_width = text_width(diagram.title, kTitleSize, true);
  picture.width = std::max(sheet.layout.size.x(), title_width) + 2 * kMargin;
  picture.height = sheet.layout.size.y() + heading + 2 * kMargin;
  if (!diagram.title.empty()) {
    picture.marks.push_back(
        label_mark({kMargin, kMargin + kTitleSize - 3}, diagram.title, Anchor::start, kTitleSize));
    std::get<Label>(picture.marks.back().shape).bold = true;
  }
  draw_sheet(sheet, "", {kMargin, kMargin + heading}, picture);
  return picture;
}

LayoutQuality drawing_quality(const Diagram& diagram, const BlockLibrary& library,
                              const DiagramDrawing& options) {
  const Schematic schematic = schematic::make_schematic(diagram, library, options.depth);
  return quality_of(make_sheet(schematic, options.symbols));
}

}  // namespace oblique
