// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/segments.h>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique::solve {

Segments::Segments(const Parts& parts)
    : program_(parts.program),
      diagram_(parts.diagram),
      options_(parts.options),
      workspace_(parts.workspace),
      switching_(parts.switching),
      clock_(parts.clock),
      branches_(parts.branches),
      sampler_(parts.sampler),
      overloads_(parts.overloads),
      states_(parts.states) {}

void Segments::follow_phases(double t) {
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
void Segments::settle(double t, bool at_branch_end) {
  workspace_.follow_branches(false);
  if (at_branch_end) branches_.pass(t, states_);
  switching_.settle(t, states_);
  follow_phases(t);
  workspace_.follow_branches(true);
}

/// Whether a switch turns over between `from` and t, where a branch of an algebraic loop has ended; t is
/// then its time. The branch may end only because the switch was not turned over.
bool Segments::turns_before(double from, double& t, const Interpolant& solution) {
  if (program_.switches().empty() || !(t > from)) return false;
  const double sample_times[] = {t};
  workspace_.pass_failing_loops(true);
  const auto event = switching_.search(from, sample_times, solution);
  workspace_.pass_failing_loops(false);
  if (event) t = *event;
  return event.has_value();
}

void Segments::end_branch(double from, const std::vector<double>& last, double& t) {
  std::vector<double> rates(states_.size());
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (states_[i] - last[i]) / (t - from);
  const StraightLine ahead(from, last, rates);
  const bool turned = turns_before(from, t, ahead);
  ahead.states_at(t, states_);
  settle(t, !turned);
}

void Segments::begin(double t) {
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
  end_ = wait ? std::min(t + *wait, last) : last;
  length_ = wait ? std::min(*wait, last - t) : last - t;
}

bool Segments::finish_step(double from, double& t, std::span<const double> sample_times,
                           const Interpolant& solution) {
  std::optional<double> branch_end = branches_.find(from, t, solution);
  std::vector<double> times_before;
  if (branch_end) {
    t = std::max(from, branches_.before(*branch_end));
    std::copy_if(sample_times.begin(), sample_times.end(), std::back_inserter(times_before),
                 [&](double sample_time) { return sample_time < t; });
    times_before.push_back(t);
    sample_times = times_before;
  }
  std::optional<double> event;
  bool settled = false;
  for (double begin = from;;) {
    while (!sample_times.empty() && sample_times.front() <= begin) sample_times = sample_times.subspan(1);
    event.reset();
    if (!program_.switches().empty() && t > begin) event = switching_.search(begin, sample_times, solution);
    const double end = event ? *event : t;
    const double reached = look_through(begin, end, sample_times, solution);
    if (halted()) {
      t = reached;
      return false;
    }
    if (!event) break;
    if (!branch_end && end < t && end < end_) {
      settled = true;
      if (turns_without_effect(end, sample_times, solution)) {
        settled = false;
        begin = end;
        continue;
      }
    }
    t = end;
    branch_end.reset();
    break;
  }
  const bool ends = event || branch_end || (t >= end_ && t < options_.until);
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
double Segments::look_through(double begin, double end, std::span<const double> sample_times,
                              const Interpolant& solution) {
  double from = begin;
  const auto to = [&](double time) {
    if (halted() || !(time > from)) return;
    if (overloads_) time = overloads_->advance(time, solution);
    sampler_.watch(from, time, solution);
    from = time;
  };
  for (const double sample_time : sample_times) to(std::min(sample_time, end));
  to(end);
  const double reached = halted() ? from : end;
  sampler_.advance(reached, solution);
  return reached;
}

/// Settles what turns over at `at`, and tells whether the solver may go on with its step as if nothing had
/// been: no state, continuous or discrete, changes, and dx/dt is the same at every one of `sample_times`,
/// which show what the time alone does. (A condition that others mask may turn over at every rounding.)
bool Segments::turns_without_effect(double at, std::span<const double> sample_times,
                                    const Interpolant& solution) {
  std::vector<std::vector<double>> states_there, before;
  std::vector<double> after(states_.size());
  bool known = !switching_.slides();
  for (const double sample_time : sample_times) {
    solution.states_at(sample_time, states_there.emplace_back(states_.size()));
    known = known && switching_.derivatives(sample_time, states_there.back().data(),
                                            before.emplace_back(states_.size()).data());
  }
  std::vector<double> discrete_states(workspace_.discrete_states().begin(),
                                      workspace_.discrete_states().end());
  solution.states_at(at, states_);
  const std::vector<double> states = states_;
  settle(at, false);
  if (!known || switching_.slides() || states_ != states) return false;
  for (const network::Switch& s : program_.switches())
    discrete_states[s.discrete_state] = workspace_.discrete_state(s.discrete_state);
  if (!std::equal(discrete_states.begin(), discrete_states.end(), workspace_.discrete_states().begin()))
    return false;
  for (std::size_t k = 0; k < sample_times.size(); ++k) {
    if (!switching_.derivatives(sample_times[k], states_there[k].data(), after.data()) || before[k] != after)
      return false;
  }
  if (overloads_) overloads_->restart(at, states_);
  switching_.known_wait(at, states_);  // announces what ends the segment
  return true;
}

}  // namespace oblique::solve
