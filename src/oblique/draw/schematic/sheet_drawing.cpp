// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/sheet_drawing.h>

#include <oblique/draw/schematic/symbols.h>

namespace oblique::draw::schematic {
namespace {

using Eigen::Vector2d;

/// The colour of a net: that of the servo loop that it is a part of.
Ink net_ink(const Schematic& schematic, std::size_t from, std::size_t output) {
  for (const Block& block : schematic.blocks) {
    for (const Input& input : block.inputs) {
      if (input.loop && input.signal->block == from && input.signal->output == output)
        return loop_ink(*input.loop);
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
  mark.signals = block.reads[net.output];
  mark.id = "net-" + prefix + block.name + "." + block.outputs[net.output];
  mark.tooltip = prefix + block.name + (block.outputs.size() > 1 ? "." + block.outputs[net.output] : "");
  picture.marks.push_back(std::move(mark));
  for (const Vector2d& junction : net.junctions) {
    picture.marks.push_back(disc_mark(at + junction, 2.5, ink, {Ink::none, 0, {}}));
    picture.marks.back().signals = block.reads[net.output];
  }
}

}  // namespace

void draw_sheet(const Sheet& sheet, const std::string& prefix, const Eigen::Vector2d& at, Picture& picture) {
  for (const RoutedNet& net : sheet.layout.nets) draw_net(sheet, net, prefix, at, picture);
  for (std::size_t b = 0; b < sheet.shapes.size(); ++b) {
    const Block& block = sheet.schematic->blocks[b];
    const Vector2d corner = at + sheet.layout.corners[b];
    draw_symbol(block, sheet.shapes[b], prefix + block.name, corner, picture);
    if (block.inside.empty()) continue;
    draw_sheet(sheet.inside[b], prefix + block.name + ".",
               corner + sheet.shapes[b].corner + Vector2d(0, kFrameTop), picture);
  }
}

}  // namespace oblique::draw::schematic
