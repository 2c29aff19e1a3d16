// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

namespace oblique::solve {

/// Nearer than this no two times are told apart [s]. Not installed.
inline double time_resolution(double t) {
  return 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
}

}  // namespace oblique::solve
