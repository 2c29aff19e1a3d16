// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <oblique/mechanism/motion/motion_range.h>

namespace oblique::mechanism {

/// The path of a point over a motion range.
struct PathMeasure {
  std::size_t point = 0;  ///< index in Mechanism::points
  double length = 0;      ///< ∫|v| dt [length unit]; a way that is gone twice counts twice
  /// ½∮(x dy − y dx) of a path that closes [length unit²]: positive where it runs counter-clockwise; loops
  /// of the other sense count against it.
  std::optional<double> area;
};

/// Lengths and areas of the paths of all moving points, by Gauss and Kronrod's rule with 7 and 15 points in
/// u, on intervals that are halved until both agree to 1e-10 of the largest link.
std::vector<PathMeasure> measure_paths(RangeWalk& walk);

}  // namespace oblique::mechanism
