// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/draw/schematic/symbol_shape.h>

namespace oblique::draw::schematic {

/// Draws a block with the upper left corner of its node at `at`; its parts carry the id "block-PATH".
void draw_symbol(const Block& block, const Shape& shape, const std::string& path, const Eigen::Vector2d& at,
                 Picture& picture);

/// The colour of a servo loop.
Ink loop_ink(std::size_t loop);

}  // namespace oblique::draw::schematic
