// SPDX-License-Identifier: MIT
// The part of Switching that serves events: what they set, and how they pile up.
#include <oblique/solve/switching.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Events that come sooner and sooner, this often in a row, pile up where the times left to them, at the
/// present ratio, are together below this part of the run, and the ratio is not on its way to 1 (events that
/// crowd together and thin out again: two balls between a heavy one and a wall). That is seen over intervals
/// that become shorter by such a factor: 1 less the ratio is then no smaller than this part of what it was.
constexpr int kMostShorter = 10;
constexpr double kPilingUp = 1e-5;
/// Three intervals are enough where they shorten this quickly, and their two ratios are the same to such a
/// part of them: they are soon within the errors of the states, where no event can be told.
constexpr double kQuickly = 0.7;
constexpr double kSameRatio = 0.01;
constexpr double kSteadyOver = 4;
constexpr double kSteady = 0.75;

}  // namespace

/// Whether an event piles up, so that the one that takes its place is to come. Throws SolveError where none
/// does.
bool Switching::piles_up(std::size_t event, double t) {
  Pace& pace = paces_[event];
  const double interval = t - pace.last;
  pace.shorter = interval > 0 && interval < pace.interval ? pace.shorter + 1 : 0;
  const double ratio = pace.interval > 0 ? interval / pace.interval : 1;
  const double left = interval * ratio / (1 - ratio);  // Σ interval · ratioᵏ
  if (pace.shorter == 0) {
    pace.steady = false;
    pace.longer = kInfinity;
  } else if (pace.longer == kInfinity || kSteadyOver * interval < pace.longer) {
    pace.steady = pace.longer < kInfinity && 1 - ratio > kSteady * pace.approach;
    pace.longer = interval;
    pace.approach = 1 - ratio;
  }
  const bool quick =
      pace.shorter > 1 && ratio < kQuickly && std::abs(ratio - pace.ratio) < kSameRatio * ratio;
  pace.ratio = ratio;
  const bool many = pace.steady && pace.shorter >= kMostShorter && interval < kPilingUp * span_;
  if ((many || quick) && left < kPilingUp * span_ && t + left < end_) {
    if (program_.events()[event].piling_up) return true;
    throw SolveError(
        SolveError::Kind::chatter, t,
        {{file_, {}},
         fmt::format("the events of '{}' come ever faster: at t = {:.9g} s again after {:.3g} s, and they "
                     "pile up at t = {:.9g} s",
                     program_.events()[event].block, t, interval, t + left),
         {},
         "end the run before, or tell the block what happens there: 'piling_up' beside 'set' in its "
         "[[events]]"});
  }
  pace.last = t;
  pace.interval = interval;
  return false;
}

/// Serves all events whose conditions have become true; true where there were any.
bool Switching::serve_events(double t, std::vector<double>& x, bool starting) {
  std::vector<std::size_t> served;
  for (std::size_t e = 0; e < held_.size(); ++e) {
    const Event& event = program_.events()[e];
    const bool holds = program_.condition(e, workspace_);
    const bool comes = holds && (!held_[e] || event.repeats) && (!starting || event.at_start);
    held_[e] = holds;
    if (comes) served.push_back(e);
  }
  if (served.empty()) return false;
  if (!program_.signals(t, x.data(), signals_.data(), workspace_))
    throw loop_error(program_, workspace_.trouble(), t, file_);
  struct Change {
    const Event::Action* action;
    double value;
  };
  std::vector<Change> changes;
  for (std::size_t e : served) {
    if (piles_up(e, t)) {
      e = *program_.events()[e].piling_up;
      record(t, program_.events()[e].block + ": its events pile up");
    } else {
      record(t, program_.events()[e].block);
    }
    const Event& event = program_.events()[e];
    for (std::size_t a = 0; a < event.actions.size(); ++a) {
      const double value = program_.action_value(e, a, workspace_);
      if (!std::isfinite(value)) {
        throw SolveError(
            SolveError::Kind::blow_up, t,
            {{file_, {}},
             fmt::format("an event of '{}' would set a value that is no finite number at t = {:.6g} s",
                         event.block, t),
             {},
             {}});
      }
      changes.push_back({&event.actions[a], value});
    }
  }
  bool jumps = false;
  for (const Change& change : changes) {
    if (change.action->on_state) {
      jumps = jumps || x[change.action->index] != change.value;
      x[change.action->index] = change.value;
    } else {
      workspace_.set_memory(change.action->index, change.value);
    }
  }
  begin_to_settle();
  if (jumps) {
    slid_.clear();
    std::fill(rested_.begin(), rested_.end(), false);
    std::fill(thresholds_.slack.begin(), thresholds_.slack.end(), 0.0);
  }
  // What was announced of surfaces that have moved away is past.
  evaluate(t, x);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (jumps || std::abs(surfaces_[s]) > thresholds_.now[s]) announced_[s] = -1;
  }
  return true;
}

}  // namespace oblique
