// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/damped_solution.h>

#include <algorithm>
#include <cmath>

namespace oblique::solve {

bool DampedSolution::begin(const Interpolant& polynomial, double length, double t, std::span<const double> x,
                           const network::Workspace& workspace) {
  polynomial_ = &polynomial;
  end_ = t;
  damping_.take_steps(length);
  return damping_.linearise(t, x, workspace);
}

void DampedSolution::states_at(double t, std::span<double> x) const {
  polynomial_->states_at(t, x);
  rates_.resize(x.size());
  residual_.resize(x.size());
  polynomial_->rates_at(t, rates_);
  if (!damping_.derivatives(t, x, residual_)) return;
  for (std::size_t i = 0; i < x.size(); ++i)
    residual_[i] = damping_.leaves(i) ? 0 : damping_.step_length() * (residual_[i] - rates_[i]);
  damping_.apply(residual_);
  const bool known =
      std::all_of(residual_.begin(), residual_.end(), [](double v) { return std::isfinite(v); });
  for (std::size_t i = 0; known && i < x.size(); ++i) {
    if (!damping_.leaves(i)) x[i] += residual_[i];
  }
}

void DampedSolution::rates_at(double t, std::span<double> dxdt) const {
  constexpr double kPart = 1e-3;  // of the step
  const double apart = kPart * damping_.step_length();
  const double from = std::max(t - apart, end_ - damping_.step_length()), to = std::min(t + apart, end_);
  if (!(to > from)) return polynomial_->rates_at(t, dxdt);
  before_.resize(dxdt.size());
  states_at(from, before_);
  states_at(to, dxdt);
  for (std::size_t i = 0; i < dxdt.size(); ++i) dxdt[i] = (dxdt[i] - before_[i]) / (to - from);
}

}  // namespace oblique::solve
