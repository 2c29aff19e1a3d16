// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/diagram_drawing.h>

#include <algorithm>

#include <oblique/draw/picture/text_width.h>
#include <oblique/draw/schematic/schematic.h>
#include <oblique/draw/schematic/sheet.h>
#include <oblique/draw/schematic/symbols.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using schematic::Block;
using schematic::Schematic;
using schematic::Sheet;

constexpr double kMargin = 24;

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
  mark.signals = block.reads[net.output];
  mark.tooltip = prefix + block.name + (block.outputs.size() > 1 ? "." + block.outputs[net.output] : "");
  picture.marks.push_back(std::move(mark));
  for (const Vector2d& junction : net.junctions) {
    picture.marks.push_back(disc_mark(at + junction, 2.5, ink, {Ink::none, 0, {}}));
    picture.marks.back().signals = block.reads[net.output];
  }
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

Picture draw_diagram(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                     const DiagramDrawing& options) {
  const Schematic schematic = schematic::make_schematic(diagram, library, options.depth);
  const Sheet sheet = schematic::make_sheet(schematic, options.symbols);
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

LayoutQuality drawing_quality(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                              const DiagramDrawing& options) {
  const Schematic schematic = schematic::make_schematic(diagram, library, options.depth);
  return quality_of(schematic::make_sheet(schematic, options.symbols));
}

std::vector<diagram::BlockPlace> drawn_places(const diagram::Diagram& diagram,
                                              const diagram::BlockLibrary& library, SymbolStyle symbols) {
  const Schematic schematic = schematic::make_schematic(diagram, library, 0);
  return schematic::places_of(schematic::make_sheet(schematic, symbols));
}

}  // namespace oblique::draw
