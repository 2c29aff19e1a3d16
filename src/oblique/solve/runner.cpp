// SPDX-License-Identifier: MIT
#include <oblique/solve/runner.h>

#include <algorithm>
#include <cstdint>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/along_branch.h>
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

constexpr double kShortest = 1e-15;  ///< of the time: the clock cannot show less

SolveError interrupted_start(const diagram::FlatDiagram& diagram, const RunOptions& options) {
  return {SolveError::Kind::other,
          options.from ? options.from->time : 0,
          {{diagram.file, {}}, "interrupted before the run had begun: it has no state yet", {}, {}}};
}

}  // namespace

Runner::Runner(const network::Program& program, const diagram::FlatDiagram& diagram,
               const RunOptions& options, const LoopStart& loop_start, const Refinement& refinement,
               bool may_end_unseen)
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
      sources_(program, workspace_,
               options.extremes                                      ? SourceWatch::Shown::extremes
               : options.watch_overloads || options.halt_on_overload ? SourceWatch::Shown::overloads
                                                                     : SourceWatch::Shown::nothing,
               diagram.file),
      branches_(program, workspace_, begin_, options, diagram.file),
      states_(program.start()),
      segments_({program, diagram, options, workspace_, switching_, clock_, branches_, sources_, sampler_,
                 overloads_, states_}) {
  constexpr double kSamplesAStep = 100, kSourceSamplesAStep = 10;
  switching_.end_at(options.until);
  switching_.end_when(interruption_);
  switching_.limit_samples(kSamplesAStep * static_cast<double>(options.max_steps) + 1e6);
  sources_.limit_samples(kSourceSamplesAStep * static_cast<double>(options.max_steps) + 1e6);
  if (!options.sensitivity.empty()) {
    sensitivities_.emplace(program, diagram, sensitivity_parameters(diagram, options.sensitivity),
                           options.until - begin_);
    sampler_.further_columns = [this](double t, std::span<const double> x, std::span<double> columns) {
      sensitivities_->outputs(
          t, x, integration_ ? integration_->sensitivities_at(t) : sensitivities_->states(), columns);
    };
  }
  if (options.watch_overloads || options.halt_on_overload)
    overloads_.emplace(program, switching_, diagram.file, options.halt_on_overload);
}

void Runner::start() {
  if (options_.from) {
    resume(*options_.from);
    switching_.know_states(refinement_.reach);  // what was saved is known as the run knew it that saved it
  } else {
    switching_.know_states(refinement_.reach);
    warnings_at_start_ = start_run(start_parts(), begin_, states_);
  }
  segments_.follow_phases(begin_);
  workspace_.follow_branches(true);
  branches_.look(begin_, states_, true, [this](std::size_t loop) { return switching_.mixes(loop); });
  if (sensitivities_) {
    if (switching_.slides()) sensitivities_->refuse_slide(begin_);
    sensitivities_->start(begin_, states_, workspace_, switching_.served(), options_.from.has_value());
  }
  last_whole_ = RunSnapshot(begin_, parts());
  piece_begin_ = piece_end_ = begin_;
}

Run Runner::run() {
  start();
  try {
    step_to_end();
  } catch (const Interrupted&) {
    end_ = last_whole_.time();
    last_whole_.restore(parts());
  }
  finish();
  return std::move(sampler_.result);
}

void Runner::step_to_end() {
  const auto keep_statistics = [&] {
    if (!integration_) return;
    sampler_.result.statistics = integration_->solver().statistics();
    sampler_.result.method = integration_->method();
  };
  try {
    while (look_ahead()) pass();
    if (integration_) integration_->end(t_);
    switching_.end(t_);
  } catch (const Interrupted&) {
    keep_statistics();
    throw;
  }
  keep_statistics();
}

/// Gathers what the run has given.
void Runner::finish() {
  sampler_.result.events = events();
  std::vector<double>& times = sampler_.result.event_times;
  times = switching_.log().times();
  for (const EventRecord& jump : branches_.jumps())
    times.insert(std::upper_bound(times.begin(), times.end(), jump.time), jump.time);
  sampler_.result.event_count = switching_.log().count() + static_cast<long>(branches_.jumps().size());
  sampler_.result.state = RunSnapshot(end_, parts()).named(program_);
  sampler_.result.warnings = warnings();
  if (overloads_) {
    sampler_.result.peaks = overloads_->peaks();
    sampler_.result.overloads = overloads_->overloads();
    sampler_.result.halted = overloads_->halted();
  }
}

std::vector<text::Diagnostic> Runner::warnings() const {
  std::vector<text::Diagnostic> all = warnings_at_start_;
  const auto add = [&](const std::vector<text::Diagnostic>& some) {
    all.insert(all.end(), some.begin(), some.end());
  };
  add(branches_.warnings());
  add(switching_.log().warnings());
  add(sampler_.warnings());
  if (integration_) add(integration_->warnings());
  return all;
}

Unseen Runner::unseen() const {
  Unseen unseen = integration_ ? integration_->unseen() : Unseen{};
  unseen.faint = switching_.faint_turns();
  if (!integration_) return unseen;
  const std::vector<std::size_t> lost = integration_->lost(sampler_.states_without_value());
  unseen.lost.insert(unseen.lost.end(), lost.begin(), lost.end());
  return unseen;
}

StartOutcome Runner::outcome_of_start() {
  StartOutcome outcome{
      std::vector<double>(program_.unknowns().size()), std::vector<double>(program_.n_signals()), {}};
  settle_start(start_parts(), begin_, states_);
  for (std::size_t u = 0; u < outcome.unknowns.size(); ++u) outcome.unknowns[u] = workspace_.unknown(u);
  switching_.signals(begin_, states_.data(), outcome.signals.data());
  outcome.runs_away = switching_.loops_that_run_away(begin_, states_);
  return outcome;
}

void Runner::resume(const RunState& state) {
  RunState from = state;
  for (std::size_t e = 0; from.turned && e < from.conditions.size(); ++e)
    from.conditions[e] = from.conditions[e] && !program_.events()[e].of_mode;
  RunSnapshot(from).restore(parts());
  switching_.resume(begin_, states_);
}

/// Whether growth was not seen so long ago that the run, which must be made again, is not worth its end.
bool Runner::ends_unseen() {
  constexpr std::int64_t kMore = 1000;
  if (!may_end_unseen_ || !integration_ || !integration_->any_unseen_growth()) return false;
  if (!steps_unseen_) steps_unseen_ = steps_;
  return steps_ > 2 * *steps_unseen_ + kMore;
}

bool Runner::goes_on(double t) {
  end_ = t;
  if (!(t < options_.until) || segments_.halted() || interruption_.is_asked()) return false;
  if (options_.interrupted) last_whole_ = RunSnapshot(t, parts());
  return true;
}

/// Begins the steps.
void Runner::begin_steps() {
  t_ = begin_;
  if (program_.n_states() == 0) return segments_.begin(t_);
  MethodChoice method =
      choose_method(options_.method, program_, workspace_, begin_, states_, options_.until - begin_);
  segments_.begin(t_);
  integration_.emplace(
      Integration::Parts{program_, diagram_, options_, workspace_, switching_, system_, branches_, sources_,
                         segments_, overloads_, states_, sensitivities_},
      std::move(method), refinement_, begin_);
}

/// Takes the next step; false where none came of it. A diagram without states follows the time alone: in
/// steps as long as the rows are apart, or shorter where that is asked for.
bool Runner::take_step() {
  if (integration_) {
    const std::size_t jumps = branches_.jumps().size();
    const bool taken = integration_->take_step(t_);
    if (sensitivities_ && branches_.jumps().size() > jumps) sensitivities_->refuse_jump(t_);
    return taken;
  }
  const double step = std::min((options_.until - begin_) / (options_.samples - 1), options_.max_step);
  const double from = t_;
  t_ = std::min(segments_.end(), t_ + step);
  if (segments_.end() - t_ < kShortest * segments_.end()) t_ = segments_.end();
  switching_.stand_at(from, states_);
  segments_.take_step(from, t_, sources_.sample_times(from, t_, no_states_, switching_.slides()), no_states_);
  return true;
}

bool Runner::look_at_piece() {
  if (!looked_ahead_) {
    sampler_.advance(begin_, ConstantStates(states_));
    if (overloads_) overloads_->restart(begin_, states_);
    begin_steps();
    looked_ahead_ = true;
  }
  while (!in_step_) {
    if (ends_unseen() || !goes_on(t_)) return false;
    piece_begin_ = t_;
    in_step_ = take_step();
  }
  piece_end_ = segments_.look_ahead();
  return true;
}

void Runner::pass_piece() {
  const Segments::Passed passed = segments_.pass(t_);
  if (sensitivities_) {
    if (integration_)
      sensitivities_->pass(piece_begin_, t_, integration_->solver());
    else
      sensitivities_->pass(piece_begin_, t_, ConstantStates(states_));
  }
  if (sensitivities_ && passed == Segments::Passed::segment) {
    if (switching_.slides()) sensitivities_->refuse_slide(t_);
    std::vector<double> before = states_;
    if (integration_) integration_->solver().states_at(t_, before);
    sensitivities_->before_event(
        t_, before, integration_ ? integration_->sensitivities_at(t_) : sensitivities_->states());
    sensitivities_->after_event(t_, states_, workspace_, switching_.served());
  }
  piece_begin_ = t_;
  if (segments_.halted()) {  // within a step, at whose end the solver is
    std::vector<double> signals;
    in_step_ = true;
    go_to(t_, signals);
    in_step_ = false;
    ++steps_;
    return;
  }
  in_step_ = passed == Segments::Passed::piece;
  if (in_step_ && integration_) integration_->go_on(t_);
  if (in_step_) return;
  if (!integration_) {
    if (passed == Segments::Passed::segment) segments_.begin(t_);
    return;
  }
  integration_->end_step(passed, t_);
  ++steps_;
  constexpr std::int64_t kStepsPerReport = 256;
  if (options_.progress && steps_ % kStepsPerReport == 0)
    options_.progress((t_ - begin_) / (options_.until - begin_));
}

void Runner::throw_failure(const SolverFailure& failure) {
  if (!integration_) throw failure;
  if (sensitivities_)
    sensitivities_->refuse_growth(failure.time, integration_->sensitivities_at(failure.time));
  throw run_error(program_, failure, integration_->solver(), workspace_, diagram_.file);
}

bool Runner::look_ahead() {
  try {
    return look_at_piece();
  } catch (const SolverFailure& failure) {
    throw_failure(failure);
  }
}

void Runner::pass() {
  try {
    pass_piece();
  } catch (const SolverFailure& failure) {
    throw_failure(failure);
  }
}

/// Evaluates at a time of the piece; leaves the states and the unknowns of loops there.
void Runner::go_to(double t, std::vector<double>& signals) {
  signals.resize(program_.n_signals());
  const double reached = evaluate_along_branch(piece_end_, t, workspace_, [&](double at) {
    if (in_step_ && integration_) integration_->solver().states_at(at, states_);
    return switching_.signals(at, states_.data(), signals.data());
  });
  if (reached != t) throw loop_error(program_, workspace_.trouble(), t, diagram_.file);
}

/// Does some work, and brings the states and the unknowns of loops back to what they were: what is read
/// changes none of the steps that follow.
template <class Work>
void Runner::undone(const Work& work) {
  const RunSnapshot here(t_, parts());
  try {
    work();
  } catch (...) {
    here.restore_values(parts());
    throw;
  }
  here.restore_values(parts());
}

void Runner::signals_at(double t, std::vector<double>& signals) {
  undone([&] { go_to(t, signals); });
}

RunState Runner::state_at(double t) {
  RunState state;
  std::vector<double> signals;
  undone([&] {
    go_to(t, signals);
    state = RunSnapshot(t, parts()).named(program_);
  });
  return state;
}

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

StartChoice start_of(const network::Program& program, const diagram::FlatDiagram& diagram,
                     const RunOptions& options) {
  if (options.from) return {};
  const Refinement refinement;
  const auto start = [&](const LoopStart& from) {
    Runner runner(program, diagram, options, from, refinement, false);
    StartAttempt attempt;
    try {
      attempt.outcome = runner.outcome_of_start();
    } catch (const SolveError&) {  // there is none from here
    } catch (const Interrupted&) {
      throw interrupted_start(diagram, options);
    }
    attempt.loop_evaluations = runner.loop_evaluations();
    return attempt;
  };
  return choose_start(program, 0, diagram.file, start);
}

}  // namespace oblique::solve
