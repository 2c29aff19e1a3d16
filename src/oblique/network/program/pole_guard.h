// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <oblique/network/graph/interval.h>
#include <oblique/network/program/loop_matrix.h>

namespace oblique::network {

/// Tells whether the equations of an algebraic loop have values all along a step of its unknowns. Beyond a
/// pole (of a quotient, a tangent), or a gap in the domain of a root, lies another branch of solutions, to
/// which a step of Newton's method may leap, though the solution itself goes on on this side. Not installed.
class PoleGuard {
 public:
  /// Whether the equations can have a pole or a gap by their unknowns at all.
  bool needed(const LoopCode& loop, std::span<const Instruction> body);

  /// Whether interval arithmetic finds values on the whole way from `start` to where the unknowns' slots
  /// stand.
  bool has_values(const LoopCode& loop, std::span<const Instruction> body, const double* slots,
                  const Eigen::VectorXd& start);

 private:
  enum class Needed : std::uint8_t { unknown, no, yes };
  Needed needed_ = Needed::unknown;
  std::vector<Interval> ranges_;
};

}  // namespace oblique::network
