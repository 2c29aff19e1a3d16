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
  std::vector<double> left;
  if (!left_.empty()) left.assign(errors.begin(), errors.end());
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = leaves(i) ? 0 : errors[i] / length_;
  matrix_->solve(errors);  // (1/h − J)⁻¹/h
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (leaves(i)) errors[i] = left[i];
  }
}

}  // namespace oblique::solve
