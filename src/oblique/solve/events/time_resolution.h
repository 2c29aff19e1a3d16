// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

namespace oblique::solve {

/// Nearer than this no two times are told apart [s]. Not installed.
inline double time_resolution(double t) {
  return 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
}

/// How far from zero a linear event function of this rate may be at the very time of its zero, as far as that
/// is known.
inline double off_at_zero(double t, double rate) {
  return 8 * time_resolution(t) * std::abs(rate);
}

}  // namespace oblique::solve
