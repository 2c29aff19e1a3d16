// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/error_damping.h>

#include <algorithm>
#include <cmath>

namespace oblique::solve {

bool ErrorDamping::linearise(double t, std::span<const double> x, const network::Workspace& workspace) {
  if (!matrix_) matrix_.emplace(program_.jacobian_pattern());
  scratch_ = workspace;
  jacobian_.resize(program_.jacobian_pattern().entries());
  if (!program_.jacobian(t, x.data(), jacobian_.data(), *scratch_)) return false;
  return std::all_of(jacobian_.begin(), jacobian_.end(), [](double v) { return std::isfinite(v); }) &&
         matrix_->factorise(jacobian_, 1 / length_);
}

bool ErrorDamping::derivatives(double t, std::span<const double> x, std::span<double> dxdt) {
  return program_.derivatives(t, x.data(), dxdt.data(), *scratch_);
}

void ErrorDamping::apply(std::span<double> errors) {
  for (double& error : errors) error /= length_;  // (1/h − J)⁻¹/h
  matrix_->solve(errors);
}

}  // namespace oblique::solve
