// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/branch_end.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/integrator/integration.h>
#include <oblique/solve/integrator/overload.h>
#include <oblique/solve/integrator/phase_clock.h>
#include <oblique/solve/integrator/refinement.h>
#include <oblique/solve/integrator/sampler.h>
#include <oblique/solve/integrator/segments.h>
#include <oblique/solve/integrator/source_watch.h>
#include <oblique/solve/integrator/switched_system.h>
#include <oblique/solve/interruption.h>
#include <oblique/solve/operating_point/other_solutions.h>
#include <oblique/solve/operating_point/run_start.h>
#include <oblique/solve/run.h>
#include <oblique/solve/run_snapshot.h>
#include <oblique/solve/sensitivity/sensitivities.h>

namespace oblique::solve {

/// One run from its start to its end: smooth segments, and events between them. Whoever wants to read the
/// machine in between goes by `start`, and then by `look_ahead` and `pass` in turns, instead of `run`:
/// between these two the machine can be read at any time of the piece that was looked at. Not installed.
class Runner {
 public:
  /// The algebraic loops begin from `loop_start`. With `may_end_unseen` it ends early where it must be made
  /// again: it has met growth that it did not see, long ago. All must outlive this.
  Runner(const network::Program& program, const diagram::FlatDiagram& diagram, const RunOptions& options,
         const LoopStart& loop_start, const Refinement& refinement, bool may_end_unseen);

  /// The whole run. Throws SolveError, and Interrupted where it has not begun.
  Run run();

  /// Settles the machine at its start, or goes on from where it was saved. Throws SolveError.
  void start();
  /// Looks at the next smooth piece, to where something turns over or a step ends; false at the end of the
  /// run. Throws SolveError.
  bool look_ahead();
  /// Settles what ends that piece, and goes on from there. Throws SolveError.
  void pass();
  /// The piece that was looked at last is from here to there [s]; both are the start before.
  double piece_begin() const { return piece_begin_; }
  double piece_end() const { return piece_end_; }
  /// All signals at a time of the piece, and the state of the run there. Throws SolveError.
  void signals_at(double t, std::vector<double>& signals);
  RunState state_at(double t);
  /// What has happened so far, and what was not seen.
  std::vector<EventRecord> events() const { return branches_.merged_with(switching_.log().records()); }
  std::vector<text::Diagnostic> warnings() const;

  /// Only what the start leads to.
  StartOutcome outcome_of_start();
  /// How often it has evaluated the equations of loops.
  std::size_t loop_evaluations() const { return workspace_.loop_evaluations(); }

  /// After the run, also one that failed: the steps that it took.
  std::int64_t steps() const { return steps_; }
  /// And what it did not see.
  Unseen unseen() const;

 private:
  StartParts start_parts() { return {program_, diagram_, options_, loop_start_, workspace_, switching_}; }
  RunParts parts() { return {program_, states_, workspace_, switching_, clock_}; }
  void resume(const RunState& state);
  void go_to(double t, std::vector<double>& signals);
  template <class Work>
  void undone(const Work& work);
  bool ends_unseen();
  bool goes_on(double t);
  void begin_steps();
  bool take_step();
  bool look_at_piece();
  void pass_piece();
  [[noreturn]] void throw_failure(const SolverFailure& failure);
  void step_to_end();
  void finish();

  const network::Program& program_;
  const diagram::FlatDiagram& diagram_;
  const RunOptions& options_;
  const LoopStart& loop_start_;
  const Refinement& refinement_;
  bool may_end_unseen_;
  double begin_, end_ = 0;  ///< [s]
  network::Workspace workspace_;
  Switching switching_;
  PhaseClock clock_;
  Interruption interruption_;
  SwitchedSystem system_;
  Sampler sampler_;
  SourceWatch sources_;
  BranchWatch branches_;
  std::optional<OverloadWatch> overloads_;
  std::vector<double> states_;
  Segments segments_;
  std::vector<text::Diagnostic> warnings_at_start_;
  const ConstantStates no_states_{{}};
  std::optional<Sensitivities> sensitivities_;
  std::optional<Integration> integration_;
  double t_ = 0;                            ///< [s] where the last piece ended
  double piece_begin_ = 0, piece_end_ = 0;  ///< [s]
  bool in_step_ = false,
       looked_ahead_ = false;  ///< whether pieces are left of a step; one has been looked at
  std::int64_t steps_ = 0;
  std::optional<std::int64_t> steps_unseen_;  ///< until growth was first unseen

  RunSnapshot last_whole_;  ///< the last whole step, where the run may be interrupted
};

/// Chooses where the loops of elements without memory start; a run that goes on has chosen already.
StartChoice start_of(const network::Program& program, const diagram::FlatDiagram& diagram,
                     const RunOptions& options);

/// What became apparent in one run, also in one that failed.
struct Observed {
  Unseen unseen;
  std::int64_t steps = 0;
};

/// A Runner's whole run, and what became apparent in it. Throws SolveError.
Run run_once(const network::Program& program, const diagram::FlatDiagram& diagram, const RunOptions& options,
             const LoopStart& loop_start, const Refinement& refinement, bool may_end_unseen,
             Observed& observed);

}  // namespace oblique::solve
