// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/diagram_drawing.h>

#include <algorithm>

#include <oblique/draw/picture/text_width.h>
#include <oblique/draw/schematic/schematic.h>
#include <oblique/draw/schematic/sheet.h>
#include <oblique/draw/schematic/sheet_drawing.h>

namespace oblique::draw {
namespace {

using schematic::Schematic;
using schematic::Sheet;

constexpr double kMargin = 24;

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
  schematic::draw_sheet(sheet, "", {kMargin, kMargin + heading}, picture);
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
