// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// A system dx/dt = f(t, x) as the solver sees it.
class OdeSystem {
 public:
  virtual ~OdeSystem() = default;
  virtual std::size_t size() const = 0;
  virtual const network::SparsePattern& pattern() const = 0;
  /// False where f has no value at (t, x); the solver then tries a shorter step.
  virtual bool derivatives(double t, const double* x, double* dxdt) = 0;
  /// df/dx in the order of `pattern`; false as above.
  virtual bool jacobian(double t, const double* x, double* values) = 0;
  /// How fast a state drives itself away, by the Jacobian that was asked for last: its largest entry ∂f/∂x of
  /// a state by itself [1/s], 0 where none is positive.
  virtual double own_growth() const { return 0; }
  /// Whether `jacobian` is df/dx to rounding, and has all its entries; else it is good for Newton's method.
  virtual bool is_jacobian_exact() const { return true; }
  /// Marks the states that a slide at (t, x) may hold at zero: those that its event functions read.
  virtual void mark_held(double /*t*/, const double* /*x*/, std::vector<bool>& /*held*/) const {}
  /// By how much a step of `h` seconds is to take what slides back to its switching surface, where
  /// `derivatives` leaves it where it is; false where nothing is to be.
  virtual bool way_back(double /*t*/, const double* /*x*/, double /*h*/, double* /*change*/) { return false; }
  /// Whether f may depend on the time.
  virtual bool depends_on_time() const { return true; }
  /// Whether the solver is to end, also in the midst of a step.
  virtual bool is_to_end() const { return false; }
};

}  // namespace oblique::solve
