// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>

namespace oblique::solve {

/// The solution within the last step of a solver.
class Interpolant {
 public:
  virtual ~Interpolant() = default;
  /// The states at a time within the step.
  virtual void states_at(double t, std::span<double> x) const = 0;
  /// d states/dt of the interpolating polynomial there.
  virtual void rates_at(double t, std::span<double> dxdt) const = 0;
};

/// States that stand still: those of a moment, or none.
class ConstantStates final : public Interpolant {
 public:
  explicit ConstantStates(std::span<const double> states) : states_(states) {}
  void states_at(double, std::span<double> x) const override {
    std::copy(states_.begin(), states_.end(), x.begin());
  }
  void rates_at(double, std::span<double> dxdt) const override { std::fill(dxdt.begin(), dxdt.end(), 0.0); }

 private:
  std::span<const double> states_;
};

}  // namespace oblique::solve
