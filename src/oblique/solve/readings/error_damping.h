// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/step_matrix.h>

namespace oblique::solve {

/// What implicit steps leave of errors of the states. A step of the length h divides an error along a mode of
/// the eigenvalue λ by 1 − hλ: a state that follows another quickly is known to its tolerance, and its
/// distance from that other, which is its rate times a short time, far better. Not installed.
class ErrorDamping {
 public:
  /// The program must outlive this.
  explicit ErrorDamping(const network::Program& program) : program_(program) {}

  /// The steps that lead to what is weighed next are as long as this [s], and damp what is fast, or the look
  /// at it does (DampedSolution); 0: there have been none since the states jumped.
  void take_steps(double length) { length_ = length; }
  bool any() const { return length_ > 0; }
  double step_length() const { return length_; }

  /// Of these states the equations are not known, since they slide: their errors stay as they are. Empty:
  /// there are none.
  void leave(std::vector<bool> states) { left_ = std::move(states); }
  bool leaves(std::size_t state) const { return !left_.empty() && left_[state]; }

  /// Takes the equations linearised at (t, x) with the discrete states of `workspace`, which is left as it
  /// is; false where they tell nothing.
  bool linearise(double t, std::span<const double> x, const network::Workspace& workspace);
  /// Replaces errors of all states by what is left of them.
  void apply(std::span<double> errors);
  /// dx/dt with those discrete states; false where it has no value.
  bool derivatives(double t, std::span<const double> x, std::span<double> dxdt);

 private:
  const network::Program& program_;
  std::optional<network::Workspace> scratch_;  ///< these two once they are needed
  std::optional<StepMatrix> matrix_;
  std::vector<double> jacobian_;
  double length_ = 0;       ///< [s]
  std::vector<bool> left_;  ///< see `leave`
};

}  // namespace oblique::solve
