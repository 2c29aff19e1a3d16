// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/text/document.h>

namespace oblique::mechanism {

/// Reads the `[expect]` of a mechanism, whose drives are known already.
void read_mechanism_expectations(const text::Value& table, Mechanism& mechanism,
                                 text::Diagnostics& diagnostics);

/// One line of `[expect]` held against the exact motion.
struct MechanismFinding {
  MechanismExpectation expectation;
  double actual = 0;
  bool met = false;
};

/// Solves for what the lines name: times and angles exactly, extremes from 3601 positions over each turn, or
/// 360 008 in all, and a parabola through the three around the extreme. Throws MechanismError for a column
/// that there is not, for a value that the first drive does not reach, and as `solve_motion`.
std::vector<MechanismFinding> check_expectations(const Mechanism& mechanism);

}  // namespace oblique::mechanism
