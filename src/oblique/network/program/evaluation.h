// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

namespace oblique::network {

class Program;
class Workspace;

/// What a Program has evaluated at one (t, x), read where it stands in the Workspace. It is good until that
/// workspace is evaluated into again, or its discrete states or unknowns are set to others; whoever reads it
/// later gets a std::logic_error, and no number of another instant. What is to be kept longer must be copied.
/// Both must outlive it.
class Evaluation {
 public:
  /// dx/dt.
  void derivatives(double* dxdt) const;
  /// The magnitude of what the event function of a switch compares.
  double compared_size(std::size_t s) const;
  /// d(event function)/dt of a switch whose event function depends on time alone, linearly; nothing for
  /// another.
  std::optional<double> known_rate(std::size_t s) const;
  /// Whether the equations and event functions only bend where a switch turns over: the pieces between which
  /// its position chooses are equal.
  bool pieces_meet(std::size_t s) const;
  /// Whether the condition of an event holds.
  bool condition(std::size_t event) const;
  /// Whether the condition holds that ends phase number `end` of those with one.
  bool phase_ends(std::size_t end) const;
  /// d(event function)/dt of every switch where the states move with `dxdt`, `n_states` of them; not a number
  /// where an algebraic loop is singular. Returned is how quickly the argument of a periodic function that a
  /// event function contains then turns [rad/s]: the largest.
  double event_function_rates(const double* dxdt, double* values) const;

 protected:
  friend class Program;
  Evaluation(const Program& program, Workspace& workspace);

  double value(std::uint32_t slot) const;

  const Program* program_;
  Workspace* workspace_;

 private:
  void check() const;

  std::uint64_t generation_;  ///< of the workspace
};

/// What follows from all signals besides.
class SignalEvaluation : public Evaluation {
 public:
  /// What an action of an event would set.
  double action_value(std::size_t event, std::size_t action) const;
  /// Where a state starts if that follows from signals; nothing for another.
  std::optional<double> start_value(std::size_t state) const;
  /// g of an algebraic loop, in the order of its unknowns: zero where it is solved.
  Eigen::VectorXd loop_residuals(std::size_t loop) const;
  /// dg/dz of an algebraic loop, rows and columns in the order of its unknowns.
  Eigen::MatrixXd loop_jacobian(std::size_t loop) const;

 private:
  friend class Program;
  using Evaluation::Evaluation;
};

}  // namespace oblique::network
