// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/draw/layout/layout.h>
#include <oblique/draw/schematic/schematic.h>
#include <oblique/draw/schematic/symbols.h>

/// A schematic with the shapes and places of its blocks. Not installed.
namespace oblique::draw::schematic {

struct Sheet {
  const Schematic* schematic = nullptr;
  std::vector<Shape> shapes;  ///< of each block
  std::vector<Sheet> inside;  ///< of each block; without a schematic where it is not open
  DiagramLayout layout;
  std::vector<diagram::BlockPlace>
      moved;  ///< of a sketch: those places that blocks needed in place of theirs
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< where the places of the file count from [px]
};

/// Lays out a schematic and all open composites in it; those of one kind that are wired alike get one layout.
/// Places that files give win; where a composite is open, what stands beside it moves away. Throws
/// DiagramError where places are too close, or leave a wire no way. `schematic` must outlive the result.
Sheet make_sheet(const Schematic& schematic, SymbolStyle style);

/// That of a sketch: blocks that are too close make room, `held` last; wires that find no way are left out
/// (the layout names their nets).
Sheet sketch_sheet(const Schematic& schematic, SymbolStyle style, const std::string& held);

/// Where the blocks of the sheet stand, in the terms of a `[layout]` table.
std::vector<diagram::BlockPlace> places_of(const Sheet& sheet);

}  // namespace oblique::draw::schematic
