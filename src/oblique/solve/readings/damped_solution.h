// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/readings/error_damping.h>

namespace oblique::solve {

/// The solution within a step, with the errors damped that its polynomial p makes there. At its end a step
/// has damped what is fast; within it p may be off by the tolerance in every direction. With the residual r =
/// f(t, p) − p′ the error obeys e′ = ∂f/∂x e − r, which one implicit step solves: what follows quickly is
/// then where its rate says. Not installed.
class DampedSolution final : public Interpolant {
 public:
  /// `damping` must outlive this.
  explicit DampedSolution(ErrorDamping& damping) : damping_(damping) {}

  /// Takes a step that ends at this time [s]; the equations were linearised there. `polynomial` must last as
  /// long as this is used.
  void begin(const Interpolant& polynomial, double end) {
    polynomial_ = &polynomial;
    end_ = end;
  }

  void states_at(double t, std::span<double> x) const override;
  /// By differences: p′ is off by as much as f(t, p) where what follows quickly is nearly there.
  void rates_at(double t, std::span<double> dxdt) const override;

 private:
  ErrorDamping& damping_;
  const Interpolant* polynomial_ = nullptr;
  double end_ = 0;
  mutable std::vector<double> rates_, residual_, before_;
};

}  // namespace oblique::solve
