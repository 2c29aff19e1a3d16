// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flat_diagram.h>

// Not installed.
namespace oblique::machine {

/// Between what a signal was over a run [machine unit].
struct SignalRange {
  double low = 0, high = 0;
  double peak() const { return std::max(std::abs(low), std::abs(high)); }
};

/// Runs a diagram as `settings` say and gives the range of every output of every block, in their order; what
/// lies between the rows is looked at too. Throws solve::SolveError.
std::vector<SignalRange> signal_ranges(diagram::FlatDiagram flat, const diagram::RunSettings& settings);

}  // namespace oblique::machine
