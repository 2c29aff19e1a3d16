// SPDX-License-Identifier: MIT
#include <oblique/solve/runner.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/branch_end.h>
#include <oblique/solve/integrator/cvodes_solver.h>
#include <oblique/solve/integrator/method.h>
#include <oblique/solve/integrator/overload.h>
#include <oblique/solve/integrator/phase_clock.h>
#include <oblique/solve/integrator/sampler.h>
#include <oblique/solve/integrator/short_steps.h>
#include <oblique/solve/integrator/source_watch.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/operating_point/singular_start.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/run_snapshot.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

/// The equations of a diagram with its switches.
class SwitchedSystem final : public OdeSystem {
 public:
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
  bool is_to_end() const override { return interruption_.is_asked(); }

 private:
  const network::Program& program_;
  Switching& switching_;
  const Interruption& interruption_;
};

/// One run from its start to its end: smooth stretches, and events between them.
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
        states_(program.start()) {
    constexpr double kLooksAStep = 100, kSourceLooksAStep = 10;
    switching_.end_at(options.until);
    switching_.end_when(interruption_);
    switching_.know_states(refinement.reach);
    switching_.limit_looks(kLooksAStep * static_cast<double>(options.max_steps) + 1e6);
    sources_.limit_looks(kSourceLooksAStep * static_cast<double>(options.max_steps) + 1e6);
    if (options.watch_overloads || options.halt_on_overload)
      overloads_.emplace(program, switching_, diagram.file, options.halt_on_overload);
  }

  Run run() {
    if (options_.from) {
      resume(*options_.from);
    } else {
      start();
    }
    follow_phases(begin_);
    workspace_.follow_branches(true);
    last_whole_ = RunSnapshot(begin_, parts());
    try {
      sampler_.advance(begin_, StandingStates(states_));
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
    settle_start();
    for (std::size_t u = 0; u < outcome.unknowns.size(); ++u) outcome.unknowns[u] = workspace_.unknown(u);
    switching_.signals(begin_, states_.data(), outcome.signals.data());
    return outcome;
  }

 private:
  void settle_start() {
    if (loop_start_.loop) {
      const std::vector<std::size_t>& unknowns = program_.loops()[*loop_start_.loop].unknowns;
      for (std::size_t i = 0; i < unknowns.size(); ++i)
        workspace_.set_unknown(unknowns[i], loop_start_.unknowns[i]);
    }
    std::vector<double> signals(program_.n_signals());
    const auto settle_all = [&] {
      switching_.start(begin_, states_, [&] {
        if (options_.settle)
          warnings_at_start_ = bring_to_rest(program_, workspace_, begin_, states_, diagram_.file);
      });
      if (!switching_.signals(begin_, states_.data(), signals.data()))
        throw loop_error(program_, workspace_.trouble(), begin_, diagram_.file);
    };
    try {
      settle_all();
    } catch (const SolveError& error) {
      if (error.kind() != SolveError::Kind::singular_loop ||
          !hold_singular_start(program_, workspace_, begin_, states_, options_.until - begin_))
        throw;
      settle_all();
    }
  }

  void start() {
    settle_start();
    std::vector<double> slopes(states_.size());
    if (switching_.derivatives(begin_, states_.data(), slopes.data())) refuse_singular_rates(slopes);
    for (text::Diagnostic& warning : unstable_branches(program_, workspace_, begin_, states_, diagram_.file))
      warnings_at_start_.push_back(std::move(warning));
  }

  void refuse_singular_rates(const std::vector<double>& slopes) const {
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      if (std::isfinite(slopes[i])) continue;
      throw SolveError(
          SolveError::Kind::blow_up, begin_,
          {{diagram_.file, {}},
           fmt::format("the rate of '{}' is no finite number where the run starts, at t = {:.6g} s",
                       program_.states()[i].name, begin_),
           "equations that have a value there",
           "start a little beside it, or write a quotient of zeros as its limit, with an if(…) in a block"});
    }
  }

  RunParts parts() { return {program_, states_, workspace_, switching_, clock_}; }

  void resume(const RunState& state) {
    RunSnapshot(state).restore(parts());
    switching_.settle(begin_, states_);
  }

  /// Begins the phases that are due at t.
  void follow_phases(double t) {
    constexpr int kMostPhases = 1000;
    if (diagram_.timeline.phases.empty()) return;
    for (int begun = 0; clock_.is_over(t, switching_.evaluate(t, states_)); ++begun) {
      if (begun > kMostPhases) {
        throw SolveError(
            SolveError::Kind::chatter, t,
            {{diagram_.file, {}},
             fmt::format("the phases of the timeline end at once, one after the other, at t = {:.6g} s", t),
             {},
             "give them a condition that is not true already, or a time"});
      }
      clock_.advance(t);
      switching_.settle(t, states_);
    }
  }

  /// Settles everything at t, where an event has come or a branch of an algebraic loop has ended.
  void settle(double t, bool at_branch_end) {
    workspace_.follow_branches(false);
    if (at_branch_end) branches_.pass(t, states_);
    switching_.settle(t, states_);
    follow_phases(t);
    workspace_.follow_branches(true);
  }

  /// Whether a switch turns over between `from` and t, where a branch of an algebraic loop has ended; t is
  /// then its time. The branch may end only because the switch was not turned over.
  bool turns_before(double from, double& t, const Interpolant& solution) {
    if (program_.switches().empty() || !(t > from)) return false;
    const double look[] = {t};
    workspace_.pass_failing_loops(true);
    const auto event = switching_.search(from, look, solution);
    workspace_.pass_failing_loops(false);
    if (event) t = *event;
    return event.has_value();
  }

  /// Settles what there is at t, where a branch ends, the states having gone straight on from `last`.
  void end_branch(double from, const std::vector<double>& last, double& t) {
    std::vector<double> rates(states_.size());
    for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (states_[i] - last[i]) / (t - from);
    const StraightLine ahead(from, last, rates);
    const bool turned = turns_before(from, t, ahead);
    ahead.states_at(t, states_);
    settle(t, !turned);
  }

  /// Sets the end of the smooth stretch that begins at t; settles what turns over at t itself.
  void begin_stretch(double t) {
    std::optional<double> wait;
    if (switching_.active()) {
      wait = switching_.known_wait(t, states_);
      for (int settled = 0; wait && !(*wait > 0); ++settled) {
        constexpr int kMostSettled = 1000;
        if (settled > kMostSettled) switching_.throw_endless(t);
        settle(t, false);
        wait = switching_.known_wait(t, states_);
      }
    }
    const double last = std::min(clock_.end(), options_.until);
    stretch_end_ = wait ? std::min(t + *wait, last) : last;
    stretch_length_ = wait ? std::min(*wait, last - t) : last - t;
  }

  /// Samples the step from `from` to t, and settles an event that cuts it short (t is then the time of the
  /// event) or ends the stretch. `looks` are times at which to look at least. True where the solver must
  /// start anew.
  bool finish_step(double from, double& t, std::span<const double> looks, const Interpolant& solution) {
    std::optional<double> branch_end = branches_.find(from, t, solution);
    std::vector<double> looks_before;
    if (branch_end) {
      t = std::max(from, branches_.before(*branch_end));
      std::copy_if(looks.begin(), looks.end(), std::back_inserter(looks_before),
                   [&](double look) { return look < t; });
      looks_before.push_back(t);
      looks = looks_before;
    }
    std::optional<double> event;
    bool settled = false;
    for (double begin = from;;) {
      while (!looks.empty() && looks.front() <= begin) looks = looks.subspan(1);
      event.reset();
      if (!program_.switches().empty() && t > begin) event = switching_.search(begin, looks, solution);
      const double end = event ? *event : t;
      const double reached = look_through(begin, end, looks, solution);
      if (halted()) {
        t = reached;
        return false;
      }
      if (!event) break;
      if (!branch_end && end < t && end < stretch_end_) {
        settled = true;
        if (turns_without_effect(end, looks, solution)) {
          settled = false;
          begin = end;
          continue;
        }
      }
      t = end;
      branch_end.reset();
      break;
    }
    const bool ends = event || branch_end || (t >= stretch_end_ && t < options_.until);
    if (!ends || t >= options_.until) return false;
    if (branch_end) {
      if (turns_before(t, *branch_end, solution)) {
        t = *branch_end;
        branch_end.reset();
      } else {
        branches_.find(t, *branch_end, solution);  // it jumps from the last place on the branch
        t = *branch_end;
      }
    }
    if (!settled) {
      solution.states_at(t, states_);
      settle(t, branch_end.has_value());
    }
    if (overloads_) overloads_->restart(t, states_);
    return true;
  }

  /// Rows, extremes and overloads from `begin` to `end`, both within one step and without events between
  /// them.
  double look_through(double begin, double end, std::span<const double> looks, const Interpolant& solution) {
    double from = begin;
    const auto to = [&](double time) {
      if (halted() || !(time > from)) return;
      if (overloads_) time = overloads_->advance(time, solution);
      sampler_.watch(from, time, solution);
      from = time;
    };
    for (const double look : looks) to(std::min(look, end));
    to(end);
    const double reached = halted() ? from : end;
    sampler_.advance(reached, solution);
    return reached;
  }

  /// Settles what turns over at `at`, and tells whether the solver may go on with its step as if nothing had
  /// been: no state and no memory changes, and dx/dt is the same at every one of `looks`, which show what the
  /// time alone does. (A condition that others mask may turn over at every rounding.)
  bool turns_without_effect(double at, std::span<const double> looks, const Interpolant& solution) {
    std::vector<std::vector<double>> states_there, before;
    std::vector<double> after(states_.size());
    bool known = !switching_.slides();
    for (const double look : looks) {
      solution.states_at(look, states_there.emplace_back(states_.size()));
      known = known && switching_.derivatives(look, states_there.back().data(),
                                              before.emplace_back(states_.size()).data());
    }
    std::vector<double> memories(workspace_.memories().begin(), workspace_.memories().end());
    solution.states_at(at, states_);
    const std::vector<double> states = states_;
    settle(at, false);
    if (!known || switching_.slides() || states_ != states) return false;
    for (const network::Switch& s : program_.switches()) memories[s.memory] = workspace_.memory(s.memory);
    if (!std::equal(memories.begin(), memories.end(), workspace_.memories().begin())) return false;
    for (std::size_t k = 0; k < looks.size(); ++k) {
      if (!switching_.derivatives(looks[k], states_there[k].data(), after.data()) || before[k] != after)
        return false;
    }
    if (overloads_) overloads_->restart(at, states_);
    switching_.known_wait(at, states_);  // announces what ends the stretch
    return true;
  }

  /// Whether growth was not seen so long ago that the run, which must be made again, is not worth its end.
  bool ends_unseen() {
    constexpr long kMore = 1000;
    if (!may_end_unseen_ || growth_->found().empty()) return false;
    if (!steps_unseen_) steps_unseen_ = steps_;
    return steps_ > 2 * *steps_unseen_ + kMore;
  }

  /// What shows that a state is not known: the outputs, then the surfaces of the switches.
  bool read(double t, const double* x, double* values) {
    std::vector<double> signals(program_.n_signals());
    if (!switching_.signals(t, x, signals.data())) return false;
    for (const diagram::FlatOutput& output : diagram_.outputs)
      *values++ = output.scale * signals[program_.signal_index(output.signal)];
    return program_.surfaces(t, x, values, workspace_).has_value();
  }

  bool halted() const { return overloads_ && overloads_->halted(); }

  bool goes_on(double t) {
    end_ = t;
    if (!(t < options_.until) || halted() || interruption_.is_asked()) return false;
    if (options_.interrupted) last_whole_ = RunSnapshot(t, parts());
    return true;
  }

  void integrate() {
    const MethodChoice method =
        choose_method(options_.method, program_, workspace_, begin_, states_, options_.until - begin_);
    sampler_.result.method = method;
    settings_ = solver_settings(program_.states(), options_, method.method, refinement_);
    double t = begin_;
    begin_stretch(t);
    CvodesSolver solver(system_, t, states_, stretch_end_, stretch_length_, settings_);
    growth_.emplace(system_, settings_);
    growth_->restart(t, states_);
    const std::size_t n_outputs = diagram_.outputs.size();
    small_.emplace(
        system_, settings_, options_.tolerance, options_.until - begin_,
        [this](double at, const double* x, double* values) { return read(at, x, values); },
        n_outputs + program_.switches().size(), n_outputs);
    small_->advance(t, states_);
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
          switch (branches_.look_ahead(t, stretch_end_, states_, solver)) {
            case BranchWatch::Ahead::end:
              end_branch(from, last, t);
              if (overloads_) overloads_->restart(t, states_);
              begin_stretch(t);
              solver.restart(t, states_, stretch_end_, stretch_length_);
              continue;
            case BranchWatch::Ahead::not_yet:
              solver.restart(t, states_, stretch_end_, stretch_end_ - t);
              continue;
            case BranchWatch::Ahead::nothing:
              throw;
          }
        }
        const std::vector<double>& looks = sources_.looks(from, t, solver);
        // The states are still those of `from`.
        if (short_steps.take_back(from, states_, looks, stretch_end_)) {
          t = from;
          continue;
        }
        if (finish_step(from, t, looks, solver)) {
          begin_stretch(t);
          solver.restart(t, states_, stretch_end_, stretch_length_);
          growth_->restart(t, states_);
          short_steps.restart();
        } else {
          std::copy(solver.states().begin(), solver.states().end(), states_.begin());
          growth_->advance(t, states_);
          short_steps.advance(t, states_, stretch_end_);
        }
        small_->advance(t, states_);
        ++steps_;
        if (ends_unseen()) break;
        if (options_.progress && steps_ % kStepsPerReport == 0)
          options_.progress((t - begin_) / (options_.until - begin_));
      }
      small_->end(t, states_);
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
    const StandingStates no_states({});
    const double step = std::min((options_.until - begin_) / (options_.samples - 1), options_.max_step);
    double t = begin_;
    begin_stretch(t);
    while (goes_on(t)) {
      const double from = t;
      t = std::min(stretch_end_, t + step);
      if (stretch_end_ - t < kShortest * stretch_end_) t = stretch_end_;
      if (finish_step(from, t, sources_.looks(from, t, no_states), no_states)) begin_stretch(t);
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
  double stretch_end_ = 0, stretch_length_ = 0;  ///< [s]
  BranchWatch branches_;
  std::optional<OverloadWatch> overloads_;
  std::vector<double> states_;
  std::vector<text::Diagnostic> warnings_at_start_;
  SolverSettings settings_;
  std::optional<GrowthWatch> growth_;
  std::optional<SmallStates> small_;
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
