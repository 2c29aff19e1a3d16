// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/segments.h>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <oblique/solve/events/time_resolution.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {

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
  if (at_branch_end) parts_.branches.pass(t, parts_.states);
  parts_.switching.settle(t, parts_.states);
  follow_phases(t);
  parts_.workspace.follow_branches(true);
  if (!parts_.switching.slides()) parts_.branches.look(t, parts_.states, false);
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

void Segments::end_branch(double from, const std::vector<double>& last, double& t) {
  std::vector<double> rates(parts_.states.size());
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (parts_.states[i] - last[i]) / (t - from);
  const StraightLine ahead(from, last, rates);
  const bool turned = turns_before(from, t, ahead);
  ahead.states_at(t, parts_.states);
  settle(t, !turned);
}

void Segments::begin(double t) {
  std::optional<double> wait;
  if (parts_.switching.active()) {
    wait = parts_.switching.known_wait(t, parts_.states);
    for (int settled = 0; wait && !(*wait > 0); ++settled) {
      constexpr int kMostSettled = 1000;
      if (settled > kMostSettled) parts_.switching.throw_endless(t);
      settle(t, false);
      wait = parts_.switching.known_wait(t, parts_.states);
    }
  }
  const double last = std::min(parts_.clock.end(), parts_.options.until);
  end_ = wait ? std::min(t + *wait, last) : last;
  length_ = wait ? std::min(*wait, last - t) : last - t;
}

std::span<const double> Segments::Step::times_left() const {
  const auto first = std::upper_bound(times.begin(), times.end(), begin);
  return std::span(times).subspan(static_cast<std::size_t>(first - times.begin()));
}

void Segments::take_step(double from, double t, std::span<const double> sample_times,
                         const Interpolant& solution) {
  step_.begin = from;
  step_.solution = &solution;
  step_.branch_end = parts_.branches.find(from, t, solution);
  step_.times.assign(sample_times.begin(), sample_times.end());
  if (step_.branch_end) {
    t = std::max(from, parts_.branches.before(*step_.branch_end));
    std::erase_if(step_.times, [&](double sample_time) { return !(sample_time < t); });
    step_.times.push_back(t);
  }
  step_.end = t;
}

double Segments::look_ahead() {
  step_.event.reset();
  if (!parts_.program.switches().empty() && step_.end > step_.begin)
    step_.event = parts_.switching.search(step_.begin, step_.times_left(), *step_.solution);
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
    if (turns_without_effect(*step_.event, step_.times_left(), *step_.solution)) {
      step_.begin = *step_.event;
      return Passed::piece;
    }
  }
  const auto branch_end = step_.event ? std::nullopt : step_.branch_end;
  const bool ends = step_.event || branch_end || (t >= end_ && t < parts_.options.until);
  if (!ends || t >= parts_.options.until) return Passed::step;
  pass_end(t, branch_end, settled);
  return Passed::segment;
}

/// Settles what there is at t, where a switch turns over, or soon after, where a branch ends.
void Segments::pass_end(double& t, std::optional<double> branch_end, bool settled) {
  if (branch_end) {
    if (turns_before(t, *branch_end, *step_.solution)) {
      t = *branch_end;
      branch_end.reset();
    } else {
      parts_.branches.find(t, *branch_end, *step_.solution);  // it jumps from the last place on the branch
      t = *branch_end;
    }
  }
  if (!settled) {
    step_.solution->states_at(t, parts_.states);
    settle(t, branch_end.has_value());
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
/// been: no state, continuous or discrete, changes, dx/dt is the same at every one of `sample_times`, which
/// show what the time alone does, and the segment does not end earlier. (A condition that others mask may
/// turn over at every rounding.)
bool Segments::turns_without_effect(double at, std::span<const double> sample_times,
                                    const Interpolant& solution) {
  std::vector<std::vector<double>> states_there, before;
  std::vector<double> after(parts_.states.size());
  bool known = !parts_.switching.slides();
  for (const double sample_time : sample_times) {
    solution.states_at(sample_time, states_there.emplace_back(parts_.states.size()));
    known = known && parts_.switching.derivatives(sample_time, states_there.back().data(),
                                                  before.emplace_back(parts_.states.size()).data());
  }
  std::vector<double> discrete_states(parts_.workspace.discrete_states().begin(),
                                      parts_.workspace.discrete_states().end());
  solution.states_at(at, parts_.states);
  const std::vector<double> states = parts_.states;
  settle(at, false);
  if (!known || parts_.switching.slides() || parts_.states != states) return false;
  for (const network::Switch& s : parts_.program.switches())
    discrete_states[s.discrete_state] = parts_.workspace.discrete_state(s.discrete_state);
  if (!std::equal(discrete_states.begin(), discrete_states.end(), parts_.workspace.discrete_states().begin()))
    return false;
  for (std::size_t k = 0; k < sample_times.size(); ++k) {
    if (!parts_.switching.derivatives(sample_times[k], states_there[k].data(), after.data()) ||
        before[k] != after)
      return false;
  }
  // What it turned over may have brought the next switch forward that follows the time alone.
  const auto wait = parts_.switching.known_wait(at, parts_.states);
  if (wait && at + *wait < end_ - time_resolution(end_)) return false;
  if (parts_.overloads) parts_.overloads->restart(at, parts_.states);
  return true;
}

}  // namespace oblique::solve
