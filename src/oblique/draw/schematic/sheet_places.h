// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/draw/layout/layout.h>
#include <oblique/draw/schematic/schematic.h>
#include <oblique/draw/schematic/symbols.h>

/// The places that a `[layout]` table gives. Not installed.
namespace oblique::draw::schematic {

/// The unit of a `[layout]`: the distance between two inputs of a block [px].
inline constexpr double kPlaceUnit = 2 * kLayoutGrid;

/// Gives the boxes of a schematic's graph the places of its layout. Throws DiagramError where two of them are
/// too close to each other.
void give_places(const Schematic& schematic, const std::vector<Shape>& shapes, SymbolStyle style,
                 LayoutGraph& graph);

/// The same for a sketch, whose composites are closed: what is too close to what stands before it in the
/// table
/// (`held` stands last) goes to the nearest place that has room. Gives the places that are others now.
std::vector<diagram::BlockPlace> give_room(const Schematic& schematic, const std::vector<Shape>& shapes,
                                           const std::string& held, LayoutGraph& graph);

/// Throws DiagramError where a wire found no way among the places.
void check_wires(const Schematic& schematic, const DiagramLayout& layout);

}  // namespace oblique::draw::schematic
