// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/cvodes_solver.h>
#include <oblique/text/diagnostic.h>

namespace oblique::solve {

/// Thrown by the `solve` stage: the diagram is well formed, but its equations could not be solved.
class SolveError : public text::Error {
 public:
  enum class Kind { singular_loop, no_rest, blow_up, step_budget, chatter, other };

  SolveError(Kind kind, double time, text::Diagnostic diagnostic)
      : text::Error(std::move(diagnostic)), kind_(kind), time_(time) {}

  Kind kind() const { return kind_; }
  double time() const { return time_; }  ///< [s] where the run stopped

 private:
  Kind kind_;
  double time_;
};

/// The error of an algebraic loop that could not be solved at time t: its members, its gain, the remedy.
/// Where the trouble is with none, that of a slide that goes nowhere.
SolveError loop_error(const network::Program& program, const network::Workspace::Trouble& trouble, double t,
                      const std::string& file);

/// The error of a run that the solver gave up: why, where, and the signals with the largest weighted local
/// errors.
SolveError run_error(const network::Program& program, const SolverFailure& failure,
                     const CvodesSolver& solver, const network::Workspace& workspace,
                     const std::string& file);

/// The error of servo loops that do not settle; `worst` are states by how fast they still move, fastest
/// first, and `loop` all states through which their loops close.
SolveError rest_error(const network::Program& program, const std::vector<std::size_t>& worst,
                      const std::vector<double>& states, const std::vector<std::size_t>& loop,
                      const std::string& file);

/// "a, b, …": the first few names of a long list.
std::string shortened(std::vector<std::string> names);

}  // namespace oblique::solve
