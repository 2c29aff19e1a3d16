// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// The matrix s I − J of a linearly implicit step, factorised: densely where it is small or full, else by
/// KLU, which analyses the pattern once and keeps its pivots from one matrix to the next as long as they
/// suit. Not installed.
class StepMatrix {
 public:
  /// J has this pattern.
  explicit StepMatrix(const network::SparsePattern& pattern);
  ~StepMatrix();

  /// Of J with these values in the order of the pattern; false where the matrix has no factors.
  bool factorise(std::span<const double> jacobian, double shift);
  /// Replaces b by the solution for it; only where there are factors.
  void solve(std::span<double> b);

 private:
  class Factors;
  class DenseFactors;
  class SparseFactors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace oblique::solve
