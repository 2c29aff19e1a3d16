// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

namespace oblique::bench {

/// The constants of the four-bar's patched diagram that are not geometry.
struct FourBarSettings {
  double gain = 1e6;
  double bandwidth = 20;  ///< [Hz]
  double until = 0;       ///< [s]
  double tolerance = 0;
  double absolute_tolerance = 0;
  int samples = 0;
};

struct FourBarRun {
  std::vector<std::array<double, 7>> rows;  ///< t [s], then x and y of B, C, M [m]
  long steps = 0;
  double seconds = 0;  ///< CPU time, from the first call of CVODES to the last row
};

/// What someone would write who has this one diagram to run and knows CVODES: the equations of
/// diagrams/mechanisms/four-bar.toml, patched, in C++ with their sparse Jacobian.
FourBarRun run_four_bar_by_hand(const FourBarSettings& settings);

}  // namespace oblique::bench
