// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <oblique/text/point_table.h>

// Not installed.
namespace oblique::machine {

/// A function of one variable as straight lines from point to point.
struct LineSegments {
  text::PointTable points;
  double error = 0;          ///< the greatest distance from the function at any x
  double low = 0, high = 0;  ///< between what the function is, where it is finite
};

/// The lines for a continuous function over [from, to], with at most `most` of them. What consists of so few
/// straight lines is found as it is; of other functions every line errs by about as much, and as little as so
/// many can, but that of a function of one sign no line goes beyond it. Where the function is not finite,
/// or jumps, the error is infinite.
LineSegments line_segments(const std::function<double(double)>& function, double from, double to, int most);

}  // namespace oblique::machine
