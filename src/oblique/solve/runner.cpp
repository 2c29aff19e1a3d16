// SPDX-License-Identifier: MIT
#include <oblique/solve/runner.h>

#include <algorithm>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/branch_end.h>
#include <oblique/solve/integrator/integration.h>
#include <oblique/solve/integrator/method.h>
#include <oblique/solve/integrator/overload.h>
#include <oblique/solve/integrator/phase_clock.h>
#include <oblique/solve/integrator/sampler.h>
#include <oblique/solve/integrator/segments.h>
#include <oblique/solve/integrator/source_watch.h>
#include <oblique/solve/integrator/switched_system.h>
#include <oblique/solve/operating_point/run_start.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/run_snapshot.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

/// One run from its start to its end: smooth segments, and events between them.
class Runner {
 public:
  Runner(const network::Program& program, const diagram::FlatDiagram& diagram, const RunOptions& options,
         const LoopStart& loop_start, const Refinement& refinement, bool may_end_unseen)
      : program_(program),
        diagram_(diagram),
        options_(options),
        loop_start_(loop_start),
        refinement_(refinement),
        may_end_unseen_(may_end_unseen),
        begin_(options.from ? options.from->time : 0),
        workspace_(program),
        switching_(program, workspace_, options.until - begin_, options.tolerance,
                   options.absolute_tolerance.value_or(kAbsoluteTolerance * options.tolerance), diagram.file),
        clock_(program, diagram.timeline, workspace_, begin_),
        interruption_(options.interrupted),
        system_(program, switching_, interruption_),
        sampler_(program, diagram, options, workspace_, switching_),
        sources_(program, workspace_, options.extremes || options.watch_overloads || options.halt_on_overload,
                 diagram.file),
        branches_(program, workspace_, begin_, options, diagram.file),
        states_(program.start()),
        segments_({program, diagram, options, workspace_, switching_, clock_, branches_, sampler_, overloads_,
                   states_}) {
    constexpr double kSamplesAStep = 100, kSourceSamplesAStep = 10;
    switching_.end_at(options.until);
    switching_.end_when(interruption_);
    switching_.limit_samples(kSamplesAStep * static_cast<double>(options.max_steps) + 1e6);
    sources_.limit_samples(kSourceSamplesAStep * static_cast<double>(options.max_steps) + 1e6);
    if (options.watch_overloads || options.halt_on_overload)
      overloads_.emplace(program, switching_, diagram.file, options.halt_on_overload);
  }

  Run run() {
    if (options_.from) {
      resume(*options_.from);
      switching_.know_states(refinement_.reach);  // what was saved is known as the run knew it that saved it
    } else {
      switching_.know_states(refinement_.reach);
      warnings_at_start_ = start_run(start_parts(), begin_, states_);
    }
    segments_.follow_phases(begin_);
    workspace_.follow_branches(true);
    last_whole_ = RunSnapshot(begin_, parts());
    try {
      sampler_.advance(begin_, ConstantStates(states_));
      if (overloads_) overloads_->restart(begin_, states_);
      step_to_end();
    } catch (const Interrupted&) {
      end_ = last_whole_.time();
      last_whole_.restore(parts());
    }
    sampler_.result.events = branches_.merged_with(switching_.log().records());
    sampler_.result.event_count = switching_.log().count() + static_cast<long>(branches_.jumps().size());
    sampler_.result.state = RunSnapshot(end_, parts()).named(program_);
    sampler_.result.warnings = std::move(warnings_at_start_);
    for (const auto* warnings : {&branches_.warnings(), &switching_.log().warnings()})
      sampler_.result.warnings.insert(sampler_.result.warnings.end(), warnings->begin(), warnings->end());
    for (text::Diagnostic& warning : sampler_.warnings())
      sampler_.result.warnings.push_back(std::move(warning));
    if (integration_) {
      for (text::Diagnostic& warning : integration_->warnings())
        sampler_.result.warnings.push_back(std::move(warning));
    }
    if (overloads_) {
      sampler_.result.peaks = overloads_->peaks();
      sampler_.result.overloads = overloads_->overloads();
      sampler_.result.halted = overloads_->halted();
    }
    return std::move(sampler_.result);
  }

  /// After `run`, also one that failed: the steps that it took.
  long steps() const { return steps_; }
  /// And what it did not see.
  Unseen unseen() const {
    Unseen unseen = integration_ ? integration_->unseen() : Unseen{};
    unseen.faint = switching_.faint_turns();
    return unseen;
  }

  StartOutcome outcome_of_start() {
    StartOutcome outcome{std::vector<double>(program_.unknowns().size()),
                         std::vector<double>(program_.n_signals())};
    settle_start(start_parts(), begin_, states_);
    for (std::size_t u = 0; u < outcome.unknowns.size(); ++u) outcome.unknowns[u] = workspace_.unknown(u);
    switching_.signals(begin_, states_.data(), outcome.signals.data());
    return outcome;
  }

 private:
  StartParts start_parts() { return {program_, diagram_, options_, loop_start_, workspace_, switching_}; }

  RunParts parts() { return {program_, states_, workspace_, switching_, clock_}; }

  void resume(const RunState& state) {
    RunSnapshot(state).restore(parts());
    switching_.resume(begin_, states_);
  }

  /// Whether growth was not seen so long ago that the run, which must be made again, is not worth its end.
  bool ends_unseen() {
    constexpr long kMore = 1000;
    if (!may_end_unseen_ || !integration_ || !integration_->any_unseen_growth()) return false;
    if (!steps_unseen_) steps_unseen_ = steps_;
    return steps_ > 2 * *steps_unseen_ + kMore;
  }

  bool goes_on(double t) {
    end_ = t;
    if (!(t < options_.until) || segments_.halted() || interruption_.is_asked()) return false;
    if (options_.interrupted) last_whole_ = RunSnapshot(t, parts());
    return true;
  }

  /// Begins the steps.
  void begin_steps() {
    t_ = begin_;
    if (program_.n_states() == 0) return segments_.begin(t_);
    const MethodChoice method =
        choose_method(options_.method, program_, workspace_, begin_, states_, options_.until - begin_);
    sampler_.result.method = method;
    segments_.begin(t_);
    integration_.emplace(Integration::Parts{program_, diagram_, options_, workspace_, switching_, system_,
                                            branches_, sources_, segments_, overloads_, states_},
                         solver_settings(program_.states(), options_, method.method, refinement_), begin_);
  }

  /// Takes the next step; false where none came of it. A diagram without states follows the time alone: in
  /// steps as long as the rows are apart, or shorter where that is asked for.
  bool take_step() {
    if (integration_) return integration_->take_step(t_);
    const double step = std::min((options_.until - begin_) / (options_.samples - 1), options_.max_step);
    const double from = t_;
    t_ = std::min(segments_.end(), t_ + step);
    if (segments_.end() - t_ < kShortest * segments_.end()) t_ = segments_.end();
    segments_.take_step(from, t_, sources_.sample_times(from, t_, no_states_), no_states_);
    return true;
  }

  /// Settles what ends the piece of a step that was looked at last, and goes on from there.
  void pass() {
    const Segments::Passed passed = segments_.pass(t_);
    in_step_ = passed == Segments::Passed::piece;
    if (in_step_) return;
    if (!integration_) {
      if (passed == Segments::Passed::segment) segments_.begin(t_);
      return;
    }
    integration_->end_step(passed, t_);
    ++steps_;
    constexpr long kStepsPerReport = 256;
    if (options_.progress && steps_ % kStepsPerReport == 0)
      options_.progress((t_ - begin_) / (options_.until - begin_));
  }

  /// Looks at the next piece of a step, which `pass` then passes; false at the end of the run.
  bool look_ahead() {
    while (!in_step_) {
      if (ends_unseen() || !goes_on(t_)) return false;
      in_step_ = take_step();
    }
    segments_.look_ahead();
    return true;
  }

  void step_to_end() {
    begin_steps();
    try {
      while (look_ahead()) pass();
      if (integration_) integration_->end(t_);
    } catch (const SolverFailure& failure) {
      throw run_error(program_, failure, integration_->solver(), workspace_, diagram_.file);
    } catch (const Interrupted&) {
      if (integration_) sampler_.result.statistics = integration_->solver().statistics();
      throw;
    }
    if (integration_) sampler_.result.statistics = integration_->solver().statistics();
  }

  static constexpr double kShortest = 1e-15;  ///< of the time: the clock cannot show less

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
  std::optional<Integration> integration_;
  double t_ = 0;          ///< [s] where the last piece ended
  bool in_step_ = false;  ///< whether a step has been taken of which pieces are left
  long steps_ = 0;
  std::optional<long> steps_unseen_;  ///< until growth was first unseen

  RunSnapshot last_whole_;  ///< the last whole step, where the run may be interrupted
};

SolveError interrupted_start(const diagram::FlatDiagram& diagram, const RunOptions& options) {
  return {SolveError::Kind::other,
          options.from ? options.from->time : 0,
          {{diagram.file, {}}, "interrupted before the run had begun: it has no state yet", {}, {}}};
}

}  // namespace

Run run_once(const network::Program& program, const diagram::FlatDiagram& diagram, const RunOptions& options,
             const LoopStart& loop_start, const Refinement& refinement, bool may_end_unseen,
             Observed& observed) {
  Runner runner(program, diagram, options, loop_start, refinement, may_end_unseen);
  const auto observe = [&] { observed = {runner.unseen(), runner.steps()}; };
  try {
    Run result = runner.run();
    observe();
    return result;
  } catch (const SolveError&) {
    observe();
    throw;
  } catch (const Interrupted&) {
    throw interrupted_start(diagram, options);
  }
}

StartOutcome start_once(const network::Program& program, const diagram::FlatDiagram& diagram,
                        const RunOptions& options, const LoopStart& loop_start) {
  const Refinement refinement;
  try {
    return Runner(program, diagram, options, loop_start, refinement, false).outcome_of_start();
  } catch (const Interrupted&) {
    throw interrupted_start(diagram, options);
  }
}

}  // namespace oblique::solve
