// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/readings/error_damping.h>

namespace oblique::solve {

/// The solution within a step, with the errors damped that its polynomial p makes there. At its end a step
/// has damped what is fast; within it p may be off by the tolerance in every direction. With the residual r =
/// f(t, p) − p′ the error obeys e′ = ∂f/∂x e − r, which one implicit step solves: what follows quickly is
/// then where its rate says. What an event within the step turns over, and the steps go on beyond it, is not
/// seen here: the equations are those in which the step was taken, to its end. Not installed.
class DampedSolution final : public Interpolant {
 public:
  /// The program must outlive this.
  explicit DampedSolution(const network::Program& program) : damping_(program) {}

  /// See ErrorDamping.
  void leave(std::vector<bool> states) { damping_.leave(std::move(states)); }
  /// Takes a step of this length [s] that ends at (t, x), and the equations linearised there with the
  /// discrete states of `workspace`; false where they tell nothing. `polynomial` must last as long as this is
  /// used.
  bool begin(const Interpolant& polynomial, double length, double t, std::span<const double> x,
             const network::Workspace& workspace);

  void states_at(double t, std::span<double> x) const override;
  /// By differences: p′ is off by as much as f(t, p) where what follows quickly is nearly there.
  void rates_at(double t, std::span<double> dxdt) const override;

 private:
  // Its own: at an event within the step errors are weighed, and the equations linearised, with what has
  // turned over halfway.
  mutable ErrorDamping damping_;
  const Interpolant* polynomial_ = nullptr;
  double end_ = 0;
  mutable std::vector<double> rates_, residual_, before_;
};

}  // namespace oblique::solve
