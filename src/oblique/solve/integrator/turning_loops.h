// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/switching.h>

namespace oblique::solve {

/// Keeps the steps of a solver short beside the turns of the algebraic loops that have a sine or the like of
/// their unknowns, and so a solution in every period: from one end of a step to the other such a loop is
/// solved from where it was, and after a turn another solution would be nearer. The angle of a vector that
/// turns evenly is a straight line, through which a solver would go in steps of many turns.
///
/// How quickly the unknowns move is measured at both ends of every step, a moment apart. Not installed.
class TurningLoops {
 public:
  /// All must outlive this.
  TurningLoops(const network::Program& program, network::Workspace& workspace, Switching& switching);

  bool any() const { return !unknowns_.empty(); }

  /// The longest step [s] at (t, x) in which none of them turns by more than half a radian at the rate that
  /// they have there; `inwards` is a time in the same segment [s], of which a thousandth is a moment.
  double longest_step(double t, std::span<const double> x, double inwards);

 private:
  bool read(double t, std::span<const double> x, std::vector<double>& unknowns);

  const network::Program& program_;
  network::Workspace& workspace_;
  Switching& switching_;
  std::vector<std::size_t> unknowns_;
  std::vector<double> signals_, rates_, beside_, here_, there_;
};

}  // namespace oblique::solve
