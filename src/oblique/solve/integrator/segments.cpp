// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/segments.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <oblique/solve/events/time_resolution.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

constexpr int kMostAtOnce = 1000;  ///< turns of what follows time alone, at one instant
constexpr double kSoon = 1e-3;     ///< of a step

}  // namespace

/// What events keep may act on the states later: by when they came, as sensitivities see it, or in a loop
/// that is looked at only along its branch.
Segments::Segments(const Parts& parts) : parts_(parts), memories_act_(follows_sensitivities()) {
  for (std::size_t loop = 0; loop < parts.program.loops().size(); ++loop)
    memories_act_ = memories_act_ || parts.program.loop_has_branches(loop);
}

void Segments::follow_phases(double t) {
  constexpr int kMostPhases = 1000;
  if (parts_.diagram.timeline.phases.empty()) return;
  for (int begun = 0; parts_.clock.is_over(t, parts_.switching.evaluate(t, parts_.states)); ++begun) {
    if (begun > kMostPhases) {
      throw SolveError(
          SolveError::Kind::chatter, t,
          {{parts_.diagram.file, {}},
           fmt::format("the phases of the timeline end at once, one after the other, at t = {:.6g} s", t),
           {},
           "give them a condition that is not true already, or a time"});
    }
    parts_.clock.advance(t);
    parts_.switching.settle(t, parts_.states);
  }
}

/// Settles everything at t, where an event has come or a branch of an algebraic loop has ended.
void Segments::settle(double t, bool at_branch_end) {
  parts_.workspace.follow_branches(false);
  if (at_branch_end)
    parts_.branches.pass(t, parts_.states, [&](std::size_t lost) {
      return parts_.switching.go_past_branch_end(lost, t, parts_.states);
    });
  parts_.switching.settle(t, parts_.states);
  follow_phases(t);
  // A loop that no derivative and no comparison needs leaves its branch here, too, if it must.
  if (!parts_.program.loops().empty()) {
    std::vector<double> signals(parts_.program.n_signals());
    parts_.switching.signals(t, parts_.states.data(), signals.data());
  }
  parts_.workspace.follow_branches(true);
  parts_.branches.look(t, parts_.states, false,
                       [this](std::size_t loop) { return parts_.switching.mixes(loop); });
}

/// Whether a switch turns over between `from` and t, where a branch of an algebraic loop has ended; t is
/// then its time. The branch may end only because the switch was not turned over.
bool Segments::turns_before(double from, double& t, const Interpolant& solution) {
  if (parts_.program.switches().empty() || !(t > from)) return false;
  const double sample_times[] = {t};
  parts_.workspace.pass_failing_loops(true);
  const auto event = parts_.switching.search(from, sample_times, solution);
  parts_.workspace.pass_failing_loops(false);
  if (event) t = *event;
  return event.has_value();
}

/// Settles a switch that turns over at t where a branch seems to end. If that is a limit that is reached only
/// where the amplifiers have left the branch, it does end.
void Segments::settle_turn(double t) {
  try {
    settle(t, false);
  } catch (const SolveError&) {
    settle(t, true);
  }
}

void Segments::end_branch(double from, const std::vector<double>& last, double& t) {
  std::vector<double> rates(parts_.states.size());
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (parts_.states[i] - last[i]) / (t - from);
  const StraightLine ahead(from, last, rates);
  const bool turned = turns_before(from, t, ahead);
  ahead.states_at(t, parts_.states);
  if (turned)
    settle_turn(t);
  else
    settle(t, true);
}

void Segments::begin(double t) {
  std::optional<double> wait;
  if (parts_.switching.active()) {
    wait = parts_.switching.known_wait(t, parts_.states);
    for (int settled = 0; wait && !(*wait > 0); ++settled) {
      if (settled > kMostAtOnce) parts_.switching.throw_endless(t);
      settle(t, false);
      wait = parts_.switching.known_wait(t, parts_.states);
    }
    if (parts_.switching.lets_pass())
      wait = parts_.switching.known_wait(t, parts_.states, EventLocation::Of::ends_of_segments);
  }
  const double last = std::min(parts_.clock.end(), parts_.options.until);
  end_ = wait ? std::min(t + *wait, last) : last;
  const double left = std::min(parts_.clock.time_left(t), parts_.options.until - t);
  length_ = wait ? std::min(*wait, left) : left;
  // Shorter than the time shows: it then ends a rounding later, when its whole length has been gone through.
  if (length_ > 0 && !(end_ > t)) end_ = std::nextafter(t, parts_.options.until);
  parts_.switching.lies_between(t, end_);
  parts_.switching.stand_at(t, parts_.states);
}

std::span<const double> Segments::Step::times_left() const {
  const auto first = std::upper_bound(times.begin(), times.end(), begin);
  return std::span(times).subspan(static_cast<std::size_t>(first - times.begin()));
}

void Segments::take_step(double from, double t, std::span<const double> sample_times,
                         const Interpolant& solution) {
  step_.begin = from;
  step_.solution = &parts_.switching.looked_at(t, solution);
  step_.times.assign(sample_times.begin(), sample_times.end());
  step_.end = t;
  find_branch_end();
}

/// Ends what is left of the step where the branch of a loop ends that no derivative needs.
void Segments::find_branch_end() {
  step_.branch_end = parts_.branches.find(step_.begin, step_.times_left(), *step_.solution);
  if (!step_.branch_end) return;
  step_.end = std::max(step_.begin, parts_.branches.before(*step_.branch_end));
  std::erase_if(step_.times, [&](double sample_time) { return !(sample_time < step_.end); });
  step_.times.push_back(step_.end);
}

/// The first of these times, or between them, at which a switch turns over. A loop may have no solution
/// beyond a switch that turns over before, such as a limit: then what follows from it says nothing.
std::optional<double> Segments::search(const std::vector<double>& times) {
  try {
    return parts_.switching.search(step_.begin, times, *step_.solution);
  } catch (const SolveError& failure) {
    if (failure.kind() != SolveError::Kind::singular_loop) throw;
    parts_.workspace.pass_failing_loops(true);
    const auto event = parts_.switching.search(step_.begin, times, *step_.solution);
    parts_.workspace.pass_failing_loops(false);
    if (!event) throw;
    return event;
  }
}

/// The first time in what is left of the step at which a switch turns over.
std::optional<double> Segments::find_event() {
  if (parts_.program.switches().empty() || !(step_.end > step_.begin)) return std::nullopt;
  std::vector<double> times(step_.times_left().begin(), step_.times_left().end());
  if (!parts_.switching.lets_pass()) return search(times);
  step_.solution->states_at(step_.begin, parts_.states);
  const auto wait = parts_.switching.known_wait(step_.begin, parts_.states, EventLocation::Of::let_pass);
  const double edge = wait ? step_.begin + *wait : step_.end;
  step_.edges_at_begin = edge > step_.begin ? 0 : step_.edges_at_begin + 1;
  if (step_.edges_at_begin > kMostAtOnce) parts_.switching.throw_endless(step_.begin);
  // One at the end of the step comes with the next, or with all that ends the segment there.
  if (!(edge < step_.end - time_resolution(step_.end))) return search(times);
  if (edge > step_.begin) {
    std::erase_if(times, [&](double time) { return time >= edge; });
    times.push_back(edge);
    if (const auto event = search(times)) return event;
  }
  return edge;
}

double Segments::look_ahead() {
  step_.event = find_event();
  const double end = step_.event.value_or(step_.end);
  step_.reached = look_through(step_.begin, end, step_.times_left(), *step_.solution);
  return step_.reached;
}

Segments::Passed Segments::pass(double& t) {
  t = step_.reached;
  if (halted()) return Passed::step;
  bool settled = false;
  if (step_.event && !step_.branch_end && *step_.event < step_.end && *step_.event < end_) {
    settled = true;
    // What has no effect on the states may have one on their sensitivities, and on those of the outputs.
    const bool without_effect =
        turns_without_effect(*step_.event, step_.times_left(), *step_.solution) && !follows_sensitivities();
    parts_.switching.let_pass(without_effect);
    if (without_effect) {
      step_.begin = *step_.event;
      find_branch_end();
      return Passed::piece;
    }
  }
  const auto branch_end = step_.event ? std::nullopt : step_.branch_end;
  const bool ends = step_.event || branch_end || (t >= end_ && t < parts_.options.until);
  if (!ends || t >= parts_.options.until) return Passed::step;
  if (!step_.event && !branch_end) {
    step_.solution->states_at(t, parts_.states);
    if (parts_.switching.lets_pass()) parts_.switching.known_wait(t, parts_.states);  // what is due with it
    settled = true;
    parts_.switching.let_pass(stands(t) && !follows_sensitivities());
  }
  pass_end(t, branch_end, settled);
  return Passed::segment;
}

/// dx/dt at t and within the step before, with the discrete states as they are now; nothing where there is
/// none.
std::vector<double> Segments::rates_behind(double t) {
  const std::size_t n = parts_.states.size();
  std::vector<double> states(n), rates(n), all;
  for (const double part : {0.5, kSoon, 0.0}) {
    const double time = t - part * (t - step_.begin);
    step_.solution->states_at(time, states);
    if (!parts_.switching.derivatives(time, states.data(), rates.data())) return {};
    all.insert(all.end(), rates.begin(), rates.end());
  }
  return all;
}

/// Settles what the time alone turns over at t, the end of the segment, and tells whether the states go on as
/// they went: none has jumped, and dx/dt, held against the step before, is the same to the bit.
bool Segments::stands(double t) {
  const bool looked = !memories_act_ && t - step_.begin > time_resolution(t);
  const std::vector<double> states = parts_.states;
  const std::vector<double> before = looked ? rates_behind(t) : std::vector<double>();
  settle(t, false);
  return !before.empty() && parts_.states == states && before == rates_behind(t);
}

/// Settles what there is at t, where a switch turns over, or soon after, where a branch ends.
void Segments::pass_end(double& t, std::optional<double> branch_end, bool settled) {
  if (branch_end) {
    const bool turns = turns_before(t, *branch_end, *step_.solution);
    if (!turns) parts_.branches.find(t, {&*branch_end, 1}, *step_.solution);  // it jumps from the last place
    t = *branch_end;
    step_.solution->states_at(t, parts_.states);
    if (turns)
      settle_turn(t);
    else
      settle(t, true);
  } else if (!settled) {
    step_.solution->states_at(t, parts_.states);
    settle(t, false);
  }
  if (parts_.overloads) parts_.overloads->restart(t, parts_.states);
}

/// Rows, extremes and overloads from `begin` to `end`, both within one step and without events between
/// them.
double Segments::look_through(double begin, double end, std::span<const double> sample_times,
                              const Interpolant& solution) {
  double from = begin;
  const auto to = [&](double time) {
    if (halted() || !(time > from)) return;
    if (parts_.overloads) time = parts_.overloads->advance(time, solution);
    parts_.sampler.watch(from, time, solution);
    from = time;
  };
  for (const double sample_time : sample_times) to(std::min(sample_time, end));
  to(end);
  const double reached = halted() ? from : end;
  parts_.sampler.advance(reached, solution);
  return reached;
}

/// Settles what turns over at `at`, and tells whether the solver may go on with its step as if nothing had
/// been: no state jumps, dx/dt is the same to the bit soon after, halfway to the end of the step, and at
/// every one of `sample_times`, which show what the time alone does, and the segment does not end earlier. (A
/// condition that others mask may turn over at every rounding; a counter acts on nothing that is integrated.)
bool Segments::turns_without_effect(double at, std::span<const double> sample_times,
                                    const Interpolant& solution) {
  std::vector<std::vector<double>> states_there, before;
  std::vector<double> after(parts_.states.size());
  bool known = true;
  std::vector<double> times(sample_times.begin(), sample_times.end());
  if (!memories_act_) times.insert(times.begin(), {at + kSoon * (step_.end - at), at + (step_.end - at) / 2});
  for (const double time : times) {
    solution.states_at(time, states_there.emplace_back(parts_.states.size()));
    known = known && parts_.switching.derivatives(time, states_there.back().data(),
                                                  before.emplace_back(parts_.states.size()).data());
  }
  std::vector<double> discrete_states(parts_.workspace.discrete_states().begin(),
                                      parts_.workspace.discrete_states().end());
  solution.states_at(at, parts_.states);
  const std::vector<double> states = parts_.states;
  settle(at, false);
  if (!known || parts_.states != states) return false;
  for (const network::Switch& s : parts_.program.switches())
    discrete_states[s.discrete_state] = parts_.workspace.discrete_state(s.discrete_state);
  const std::span<const double> now = parts_.workspace.discrete_states();
  const bool memories_stand =
      std::equal(now.begin(), now.end(), discrete_states.begin(), discrete_states.end());
  if (memories_act_ && !memories_stand) return false;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!parts_.switching.derivatives(times[k], states_there[k].data(), after.data()) || before[k] != after)
      return false;
  }
  // A memory, a clock or a comparison may have opened the way to something short, which was not seen where
  // the step was looked at.
  if (!memories_stand || parts_.switching.lets_pass() || parts_.sources.acts_anew()) {
    const auto left =
        std::count_if(sample_times.begin(), sample_times.end(), [&](double time) { return time > at; });
    if (std::ssize(parts_.sources.sample_times(at, step_.end, solution, false)) > left) return false;
  }
  // And it may have brought the next switch forward that follows the time alone.
  const auto wait = parts_.switching.known_wait(at, parts_.states, EventLocation::Of::ends_of_segments);
  if (wait && at + *wait < end_ - time_resolution(end_)) return false;
  // Or a phase has begun, which changes nothing at first and ends by the time.
  if (parts_.clock.end() < end_) return false;
  if (parts_.overloads) parts_.overloads->restart(at, parts_.states);
  return true;
}

}  // namespace oblique::solve
