// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/draw/picture/picture.h>
#include <oblique/draw/schematic/sheet.h>

namespace oblique::draw::schematic {

/// Draws the blocks and wires of a sheet, and what is in open composites, with its upper left corner at `at`;
/// what stands in the ids of the marks before the names of the blocks is `prefix`. Not installed.
void draw_sheet(const Sheet& sheet, const std::string& prefix, const Eigen::Vector2d& at, Picture& picture);

}  // namespace oblique::draw::schematic
