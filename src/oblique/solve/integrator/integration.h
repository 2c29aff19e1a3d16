// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/events/branch_end.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/integrator/cvodes_solver.h>
#include <oblique/solve/integrator/growth_watch.h>
#include <oblique/solve/integrator/lost_outputs.h>
#include <oblique/solve/integrator/overload.h>
#include <oblique/solve/integrator/refinement.h>
#include <oblique/solve/integrator/segments.h>
#include <oblique/solve/integrator/short_steps.h>
#include <oblique/solve/integrator/small_states.h>
#include <oblique/solve/integrator/source_watch.h>
#include <oblique/solve/integrator/switched_system.h>
#include <oblique/solve/integrator/turning_loops.h>
#include <oblique/solve/run.h>

namespace oblique::solve {

/// The steps of a run with states: those of a solver, and what watches them for what it does not see. Each
/// is given to the segments; who runs looks at it there, piece by piece, and tells how it ended. Not
/// installed.
class Integration {
 public:
  /// What a run is made of; `overloads` only where they are watched, `sensitivities` where they are asked
  /// for.
  struct Parts {
    const network::Program& program;
    const diagram::FlatDiagram& diagram;
    const RunOptions& options;
    network::Workspace& workspace;
    Switching& switching;
    SwitchedSystem& system;
    BranchWatch& branches;
    SourceWatch& sources;
    Segments& segments;
    std::optional<OverloadWatch>& overloads;
    std::vector<double>& states;
    std::optional<Sensitivities>& sensitivities;
  };

  /// Begins at time t with this method, which may become another where the diagram leaves it open. All must
  /// outlive this.
  Integration(const Parts& parts, MethodChoice method, const Refinement& refinement, double t);

  /// Takes a step from t into the segments; t is then where it ends. False where none came of it: it is to be
  /// tried again, from the t that is left. Throws SolverFailure, SolveError and Interrupted.
  bool take_step(double& t);
  /// Goes on from t, where a step has ended or the segment with it.
  void end_step(Segments::Passed passed, double t);
  /// Goes on with a step at t, where switches have turned over that the states do not notice.
  void go_on(double t);
  /// Looks at the end of the run.
  void end(double t);

  const Solver& solver() const { return *solver_; }
  const MethodChoice& method() const { return method_; }
  /// The sensitivities that are followed, at a time within the last step.
  std::vector<std::vector<double>> sensitivities_at(double t) const { return cvodes_->sensitivities_at(t); }
  /// What the steps did not see.
  Unseen unseen() const;
  /// Those of the states x, as far as no tolerance was asked for them, that are zero but for errors.
  std::vector<std::size_t> lost(std::span<const double> x) const;
  /// Whether there was growth that they did not see.
  bool any_unseen_growth() const { return !growth_.found().empty(); }
  /// Warnings about outputs that the states do not give.
  std::vector<text::Diagnostic> warnings() const;

 private:
  std::unique_ptr<Solver> make_solver(double t);
  bool read_outputs(double t, const double* x, double* values);
  bool read(double t, const double* x, double* values);
  void restart(double t);
  void watch_places();
  void limit_step(double t);
  bool turns_too_far(double from, double t);
  bool outruns_growth(double from, double t);
  void look_for_stiffness(double t);

  Parts parts_;
  MethodChoice method_;
  const Refinement& refinement_;
  SolverSettings settings_;
  CvodesSolver* cvodes_ = nullptr;  ///< the solver, if that is what it is
  std::unique_ptr<Solver> solver_;
  GrowthWatch growth_;
  SmallStates small_;
  LostOutputs lost_;
  ShortSteps short_steps_;
  TurningLoops turning_;
  std::optional<double> turn_limit_;               ///< [s] of the next step, where it is known
  double places_limit_ = kNone;                    ///< [s] of a step, for the places to look at in it
  double growth_limit_ = kNone;                    ///< [s] of a step, while it would outrun growth
  int limited_steps_ = 0;                          ///< taken so
  std::size_t places_ = 0;                         ///< in the last step
  double length_ = 0;                              ///< [s] of the last step
  int ends_ = 0;                                   ///< of branches, since the last step
  bool any_event_ = false;                         ///< within it
  bool limits_ = false;                            ///< the solver's steps are limited
  double begin_;                                   ///< [s]
  long low_steps_ = 0, next_look_ = kFewLowSteps;  ///< see `look_for_stiffness`
  static constexpr long kFewLowSteps = 10;
  static constexpr double kNone = std::numeric_limits<double>::infinity();
};

}  // namespace oblique::solve
