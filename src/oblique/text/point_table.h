// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace oblique::text {

/// A function given by points, joined by straight lines of which the first and the last go on: `x` ascending,
/// at least two, and as many `y`. Two points of one x are a jump there, after which the second holds; never
/// three, and never the first two or the last two.
struct PointTable {
  std::vector<double> x, y;
  bool operator==(const PointTable&) const = default;
};

}  // namespace oblique::text
