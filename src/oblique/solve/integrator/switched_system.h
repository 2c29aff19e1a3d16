// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/integrator/ode_system.h>
#include <oblique/solve/interruption.h>

namespace oblique::solve {

/// The equations of a diagram with its switches. Not installed.
class SwitchedSystem final : public OdeSystem {
 public:
  /// All must outlive this.
  SwitchedSystem(const network::Program& program, Switching& switching, const Interruption& interruption)
      : program_(program), switching_(switching), interruption_(interruption) {}
  std::size_t size() const override { return program_.n_states(); }
  const network::SparsePattern& pattern() const override { return program_.jacobian_pattern(); }
  bool derivatives(double t, const double* x, double* dxdt) override {
    return switching_.derivatives(t, x, dxdt);
  }
  bool jacobian(double t, const double* x, double* values) override {
    return switching_.jacobian(t, x, values);
  }
  /// In a slide the shares of its sides depend on the states and on the time, and their derivatives are not
  /// in the Jacobian.
  bool is_jacobian_exact() const override { return !switching_.slides(); }
  void mark_held(double t, const double* x, std::vector<bool>& held) const override {
    switching_.mark_held(t, x, held);
  }
  bool way_back(double t, const double* x, double h, double* change) override {
    return switching_.way_back(t, x, h, change);
  }
  bool depends_on_time() const override;
  bool is_to_end() const override { return interruption_.is_asked(); }

 private:
  const network::Program& program_;
  Switching& switching_;
  const Interruption& interruption_;
  mutable std::optional<bool> by_time_;  ///< whether the equations depend on the time, once that was asked
};

}  // namespace oblique::solve
