// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

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
      : program_(program),
        switching_(switching),
        interruption_(interruption),
        own_entries_(own_entries(pattern())) {}
  std::size_t size() const override { return program_.n_states(); }
  const network::SparsePattern& pattern() const override { return program_.jacobian_pattern(); }
  bool derivatives(double t, const double* x, double* dxdt) override {
    return switching_.derivatives(t, x, dxdt);
  }
  bool jacobian(double t, const double* x, double* values) override {
    const bool known = switching_.jacobian(t, x, values);
    own_growth_ = 0;
    for (const std::size_t entry : own_entries_) own_growth_ = std::max(own_growth_, values[entry]);
    return known;
  }
  double own_growth() const override { return own_growth_; }
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
  static std::vector<std::size_t> own_entries(const network::SparsePattern& pattern) {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      for (auto k = pattern.column_starts[i]; k < pattern.column_starts[i + 1]; ++k) {
        if (pattern.rows[static_cast<std::size_t>(k)] == static_cast<std::int64_t>(i))
          own.push_back(static_cast<std::size_t>(k));
      }
    }
    return own;
  }

  const network::Program& program_;
  Switching& switching_;
  const Interruption& interruption_;
  std::vector<std::size_t> own_entries_;  ///< of the Jacobian: of each state by itself
  double own_growth_ = 0;
  mutable std::optional<bool> by_time_;  ///< whether the equations depend on the time, once that was asked
};

}  // namespace oblique::solve
