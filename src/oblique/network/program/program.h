// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <oblique/network/assembly/network.h>
#include <oblique/network/graph/interval.h>
#include <oblique/network/program/evaluation.h>
#include <oblique/network/program/loop_solver.h>
#include <oblique/network/program/program_code.h>
#include <oblique/network/program/switch_structure.h>

namespace oblique::network {

struct FlatEquations;
class ParameterPrologue;
class ParameterSetting;
class Workspace;

/// The equations of a diagram, compiled: immutable, and shared between threads as long as each has a
/// Workspace. Nothing allocates inside `derivatives`, `signals` and, where every entry has a value,
/// `jacobian`.
class Program {
 public:
  /// Compiles a network: differentiates, shares and drops expressions, lays out the tape.
  explicit Program(Network network);
  /// The same equations with other constants: shares the code.
  Program(const Program& other, const ParameterSetting& parameters);

  std::size_t n_states() const { return code_->states.size(); }
  std::size_t n_signals() const { return code_->signal_names.size(); }
  const std::vector<State>& states() const { return code_->states; }
  const std::vector<Unknown>& unknowns() const { return code_->unknowns; }
  const std::vector<Loop>& loops() const { return code_->loops; }
  const std::vector<std::string>& signal_names() const { return code_->signal_names; }
  std::size_t signal_index(diagram::SignalRef signal) const {
    return code_->first_signal[signal.block] + signal.output;
  }
  std::size_t n_instructions() const { return code_->tape.size(); }

  /// Start values of the states, before servo loops are brought to rest.
  std::vector<double> start() const;

  /// dx/dt at (t, x). False where an algebraic loop could not be solved; `workspace.trouble()` then says
  /// which.
  bool derivatives(double t, const double* x, double* dxdt, Workspace& workspace) const;

  /// d(dx/dt)/dx in the order of `jacobian_pattern`, algebraic loops included: f_x − f_z g_z⁻¹ g_x. False as
  /// above.
  bool jacobian(double t, const double* x, double* values, Workspace& workspace) const;
  const SparsePattern& jacobian_pattern() const { return code_->pattern; }

  /// Every signal of every block at (t, x), `n_signals` of them, and what else follows from them; nothing
  /// where `derivatives` would give false.
  std::optional<SignalEvaluation> signals(double t, const double* x, double* values,
                                          Workspace& workspace) const;

  // --- events: all of the above hold for the discrete states as they are in the workspace

  const std::vector<DiscreteState>& discrete_states() const { return code_->discrete_states; }
  const std::vector<Switch>& switches() const { return code_->switches; }
  const std::vector<Event>& events() const { return code_->events; }
  /// Of each group of integrators, the discrete state with its mode of operation; empty without a timeline.
  const std::vector<std::uint32_t>& mode_states() const { return code_->mode_states; }

  /// The event function of every switch at (t, x), and what else follows there; nothing as above.
  std::optional<Evaluation> event_functions(double t, const double* x, double* values,
                                            Workspace& workspace) const;
  const SwitchStructure& switch_structure() const { return code_->switch_structure; }

  /// Whether a switch follows from no algebraic loop, and its event function does not depend on its own
  /// position.
  bool is_ordered(std::size_t s) const { return code_->is_ordered[s]; }
  /// What `decide_in_order` calls: a switch, its event function, and d(event function)/dt.
  using Decide = std::function<void(std::uint32_t s, double event_function, double rate)>;
  /// Goes once through all ordered switches at (t, x), where the states move with `dxdt`: each comes after
  /// those on whose positions its event function depends, and sees them as `decide` has set them.
  void decide_in_order(double t, const double* x, const double* dxdt, Workspace& workspace,
                       const Decide& decide) const;

  const std::vector<Source>& sources() const { return code_->sources; }
  /// Where the sources that act are sums and products of sines and cosines of what goes along a straight
  /// line: the slots of constants that say how fast [1/s]. A step that no argument turns far in hides
  /// nothing.
  const std::optional<std::vector<std::uint32_t>>& turning_rate_slots() const {
    return code_->turning_rate_slots;
  }
  /// The states that sources depend on. The first `clocks` of them go along a straight line between events:
  /// integrators of what only events change.
  const std::vector<std::size_t>& source_states() const { return code_->source_states; }
  std::size_t clocks() const { return code_->n_clocks; }
  /// The values of all sources, and their derivatives, for times within `time` and the source states within
  /// `states`, on slots of the kind that `source_slots` gives, with the discrete states as they are in the
  /// workspace.
  void source_ranges(const Interval& time, std::span<const Interval> states, const Workspace& workspace,
                     std::span<Interval> slots) const;
  std::vector<Interval> source_slots() const;

  /// Whether dg/dz of a loop does not depend on its own unknowns.
  bool loop_is_linear(std::size_t loop) const { return code_->loop_codes[loop].linear; }
  /// Whether amplifiers choose among several solutions of a loop.
  bool loop_has_branches(std::size_t loop) const { return code_->loop_codes[loop].has_branches(); }
  /// Whether a loop has a function that repeats along its unknowns, as a sine, and so solutions in every
  /// period.
  bool loop_repeats(std::size_t loop) const;
  /// Whether derivatives depend on a loop.
  bool derivatives_need(std::size_t loop) const;

 private:
  friend class Workspace;
  friend class Evaluation;
  friend class SignalEvaluation;
  friend class ParameterSetting;
  friend class ParameterPrologue;
  friend FlatEquations flat_equations(const Program& program, std::span<const std::size_t> signals);

  bool run(const std::vector<ProgramCode::Step>& steps, Workspace& workspace) const;
  bool load_and_run(double t, const double* x, Workspace& workspace) const;
  bool differentiate_loops(Workspace& workspace) const;
  void complete_jacobian(double t, const double* x, double* values, Workspace& workspace) const;
  void copy_derivatives(const Workspace& workspace, double* dxdt) const;

  std::shared_ptr<const ProgramCode> code_;
  std::vector<double> initial_slots_;
};

/// The scratch memory of one run of a Program. It keeps the last solution of every algebraic loop, from which
/// the next one is sought.
class Workspace {
 public:
  explicit Workspace(const Program& program);

  /// Forgets the solutions of the loops: the next search starts from the guesses of the diagram.
  void reset();
  /// The discrete states as they are before the run.
  void reset_discrete_states();

  /// The loop that could not be solved when an evaluation last failed.
  struct Trouble {
    std::size_t loop = 0;
    LoopFailure failure = LoopFailure::none;
    double derivative = 0;  ///< dg/dz where the loop has one unknown
    double value = 0;       ///< of its first unknown where it was solved last, or its guess
  };
  const Trouble& trouble() const { return trouble_; }
  /// How often the equations of loops have been evaluated so far, of all together.
  std::size_t loop_evaluations() const;

  /// While branches are followed, a loop of which amplifiers choose the solution fails (`lost`) where its
  /// branch ends or is left; else the amplifiers go to where they rest.
  void follow_branches(bool follow);
  /// Whether a loop that fails is passed over, its unknowns as they were last: what does not depend on them
  /// is then as it should be.
  void pass_failing_loops(bool pass) { passes_failing_loops_ = pass; }
  /// Takes these values for the unknowns of a loop at time t, where it is singular: as long as they solve it
  /// or, with `whatever`, in any case. A time that is not a number lets go.
  void hold_loop(std::size_t loop, double t, const std::vector<double>& unknowns, bool whatever);

  /// The last solution of an unknown of an algebraic loop, from which the next is sought.
  double unknown(std::size_t u) const { return solved_[u]; }
  void set_unknown(std::size_t u, double value);

  /// The discrete states, between events as they are.
  std::span<const double> discrete_states() const;
  /// Sets all, or none where there are none.
  void load_discrete_states(std::span<const double> discrete_states);
  double discrete_state(std::size_t m) const { return slots_[first_discrete_state_ + m]; }
  void set_discrete_state(std::size_t m, double value) {
    double& slot = slots_[first_discrete_state_ + m];
    if (slot == value) return;
    slot = value;
    ++generation_;
  }

 private:
  friend class Program;
  friend class Evaluation;
  friend class SignalEvaluation;
  const Program* program_;
  std::size_t first_discrete_state_;
  std::vector<double> slots_;
  std::vector<double> solved_;  ///< unknowns at the last success
  std::vector<LoopWorkspace> loops_;
  std::vector<Eigen::MatrixXd> dz_dx_, dz_dt_;
  bool passes_failing_loops_ = false;
  Trouble trouble_;
  std::uint64_t generation_ = 0;  ///< goes on with whatever makes an Evaluation stale
};

}  // namespace oblique::network
