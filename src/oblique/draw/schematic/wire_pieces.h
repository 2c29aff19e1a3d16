// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

/// Geometry of laid wires. Not installed.
namespace oblique::draw {

/// Joins pieces that touch or overlap in one line, and drops those without length.
std::vector<WirePiece> merged(std::vector<WirePiece> pieces);

/// Where pieces of one net meet: where three or four come together, and how many corners there are besides.
struct WireJoints {
  std::vector<Eigen::Vector2d> junctions;
  std::size_t bends = 0;
};
WireJoints joints_of(const std::vector<WirePiece>& pieces);

/// Crossings of wires of different nets.
std::size_t count_crossings(const std::vector<RoutedNet>& nets);

}  // namespace oblique::draw
