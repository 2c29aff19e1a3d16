// SPDX-License-Identifier: MIT
#include <oblique/solve/runner.h>

#include <algorithm>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/branch_end.h>
#include <oblique/solve/integrator/cvodes_solver.h>
#include <oblique/solve/integrator/lost_outputs.h>
#include <oblique/solve/integrator/method.h>
#include <oblique/solve/integrator/overload.h>
#include <oblique/solve/integrator/phase_clock.h>
#include <oblique/solve/integrator/sampler.h>
#include <oblique/solve/integrator/segments.h>
#include <oblique/solve/integrator/short_steps.h>
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
      if (program_.n_states() > 0) {
        integrate();
      } else {
        follow();
      }
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
    if (lost_) add_warnings_of_lost_outputs();
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
    Unseen unseen;
    if (growth_) unseen.growth = growth_->found();
    if (small_) unseen.small = small_->found();
    unseen.faint = switching_.faint_turns();
    std::erase_if(unseen.small, [this](const SmallState& small) {  // it was asked for
      return program_.states()[small.state].tolerance > 0;
    });
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
    if (!may_end_unseen_ || growth_->found().empty()) return false;
    if (!steps_unseen_) steps_unseen_ = steps_;
    return steps_ > 2 * *steps_unseen_ + kMore;
  }

  /// But of those that show a state that is too small, which is told of apart.
  void add_warnings_of_lost_outputs() {
    std::vector<bool> told(diagram_.outputs.size(), false);
    for (const SmallState& small : unseen().small) {
      if (small.reading < told.size()) told[small.reading] = true;
    }
    for (text::Diagnostic& warning : lost_->warnings(told))
      sampler_.result.warnings.push_back(std::move(warning));
  }

  bool read_outputs(double t, const double* x, double* values) {
    std::vector<double> signals(program_.n_signals());
    if (!switching_.signals(t, x, signals.data())) return false;
    for (const diagram::FlatOutput& output : diagram_.outputs)
      *values++ = output.scale * signals[program_.signal_index(output.signal)];
    return true;
  }

  /// What shows that a state is not known: the outputs, then the event functions of the switches.
  bool read(double t, const double* x, double* values) {
    return read_outputs(t, x, values) &&
           program_.event_functions(t, x, values + diagram_.outputs.size(), workspace_).has_value();
  }

  bool goes_on(double t) {
    end_ = t;
    if (!(t < options_.until) || segments_.halted() || interruption_.is_asked()) return false;
    if (options_.interrupted) last_whole_ = RunSnapshot(t, parts());
    return true;
  }

  void integrate() {
    const MethodChoice method =
        choose_method(options_.method, program_, workspace_, begin_, states_, options_.until - begin_);
    sampler_.result.method = method;
    settings_ = solver_settings(program_.states(), options_, method.method, refinement_);
    double t = begin_;
    segments_.begin(t);
    CvodesSolver solver(system_, t, states_, segments_.end(), segments_.length(), settings_);
    growth_.emplace(system_, settings_);
    growth_->restart(t, states_);
    const std::size_t n_outputs = diagram_.outputs.size();
    small_.emplace(
        system_, settings_, options_.tolerance, options_.until - begin_,
        [this](double at, const double* x, double* values) { return read(at, x, values); },
        n_outputs + program_.switches().size(), n_outputs);
    small_->advance(t, states_);
    lost_.emplace(diagram_, settings_,
                  [this](double at, const double* x, double* values) { return read_outputs(at, x, values); });
    ShortSteps short_steps(
        HiddenMotion(system_, settings_.relative_tolerance,
                     settings_.own_tolerances.empty()
                         ? std::vector<double>(states_.size(), settings_.absolute_tolerance)
                         : settings_.own_tolerances),
        solver, options_.until - begin_);
    constexpr long kStepsPerReport = 256;
    try {
      while (goes_on(t)) {
        const double from = t;
        try {
          t = solver.step();
        } catch (const SolverFailure& failure) {
          if (failure.kind == SolverFailure::Kind::interrupted) throw Interrupted();
          if (failure.kind == SolverFailure::Kind::step_budget) throw;
          const std::vector<double> last = states_;
          switch (branches_.look_ahead(t, segments_.end(), states_, solver)) {
            case BranchWatch::Ahead::end:
              segments_.end_branch(from, last, t);
              if (overloads_) overloads_->restart(t, states_);
              segments_.begin(t);
              solver.restart(t, states_, segments_.end(), segments_.length());
              continue;
            case BranchWatch::Ahead::not_yet:
              solver.restart(t, states_, segments_.end(), segments_.end() - t);
              continue;
            case BranchWatch::Ahead::nothing:
              throw;
          }
        }
        const std::vector<double>& sample_times = sources_.sample_times(from, t, solver);
        // The states are still those of `from`.
        if (short_steps.take_back(from, states_, sample_times, segments_.end())) {
          t = from;
          continue;
        }
        if (segments_.finish_step(from, t, sample_times, solver)) {
          segments_.begin(t);
          solver.restart(t, states_, segments_.end(), segments_.length());
          growth_->restart(t, states_);
          short_steps.restart();
        } else {
          std::copy(solver.states().begin(), solver.states().end(), states_.begin());
          growth_->advance(t, states_);
          short_steps.advance(t, states_, segments_.end());
        }
        small_->advance(t, states_);
        lost_->advance(t, states_);
        ++steps_;
        if (ends_unseen()) break;
        if (options_.progress && steps_ % kStepsPerReport == 0)
          options_.progress((t - begin_) / (options_.until - begin_));
      }
      small_->end(t, states_);
      lost_->end(t, states_);
    } catch (const SolverFailure& failure) {
      throw run_error(program_, failure, solver, workspace_, diagram_.file);
    } catch (const Interrupted&) {
      sampler_.result.statistics = solver.statistics();
      throw;
    }
    sampler_.result.statistics = solver.statistics();
  }

  /// A diagram without states follows the time alone: steps as long as the rows are apart, or shorter where
  /// that is asked for.
  void follow() {
    const ConstantStates no_states({});
    const double step = std::min((options_.until - begin_) / (options_.samples - 1), options_.max_step);
    double t = begin_;
    segments_.begin(t);
    while (goes_on(t)) {
      const double from = t;
      t = std::min(segments_.end(), t + step);
      if (segments_.end() - t < kShortest * segments_.end()) t = segments_.end();
      if (segments_.finish_step(from, t, sources_.sample_times(from, t, no_states), no_states))
        segments_.begin(t);
    }
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
  SolverSettings settings_;
  std::optional<GrowthWatch> growth_;
  std::optional<SmallStates> small_;
  std::optional<LostOutputs> lost_;
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
