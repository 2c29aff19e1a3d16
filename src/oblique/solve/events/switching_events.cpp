// SPDX-License-Identifier: MIT
// The part of Switching that serves events: what they set, and how they pile up.
#include <oblique/solve/events/switching.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique::solve {

/// Whether an event piles up, so that the one that takes its place is to come. Throws SolveError where none
/// does.
bool Switching::piles_up(std::size_t event, double t, bool at_once) {
  const auto pile_up = paces_[event].come(t, span_, end_);
  if (!pile_up && !at_once) return false;
  const network::Event& what = program_.events()[event];
  if (what.piling_up) return true;
  const std::string told =
      pile_up
          ? fmt::format(
                "come ever faster: at t = {:.9g} s again after {:.3g} s, and they pile up at t = "
                "{:.9g} s",
                t, pile_up->interval, pile_up->at)
          : fmt::format("come again at once at t = {:.9g} s: what they set leads back to their condition", t);
  throw SolveError(SolveError::Kind::chatter, t,
                   {{file_, {}},
                    fmt::format("the events of '{}' {}", what.block, told),
                    {},
                    "end the run before, or tell the block what happens there: 'piling_up' beside 'set' in "
                    "its [[events]]"});
}

/// Whether the condition of an event that came at this instant holds because what it set leads back to it: it
/// hangs on a switch whose surface is at zero, and does not stay there.
bool Switching::comes_at_once(std::size_t event, double t, std::span<const double> x) {
  if (!came_[event]) return false;
  std::vector<double> others(surfaces_.size());
  bool hangs = false;
  for (std::size_t s = 0; s < surfaces_.size() && !hangs; ++s) {
    if (is_known(s) || stays_[s] || slide_.rests(s) || std::abs(surfaces_[s]) > thresholds_.now[s]) continue;
    const std::uint32_t memory = program_.switches()[s].memory;
    const double position = workspace_.memory(memory);
    workspace_.set_memory(memory, 1 - position);
    hangs =
        program_.surfaces(t, x.data(), others.data(), workspace_) && !program_.condition(event, workspace_);
    workspace_.set_memory(memory, position);
  }
  program_.surfaces(t, x.data(), others.data(), workspace_);  // leaves everything as it was
  return hangs;
}

/// Serves all events whose conditions have become true; true where there were any.
bool Switching::serve_events(double t, std::vector<double>& x, bool starting) {
  std::vector<std::size_t> served;
  std::vector<bool> at_once(held_.size(), false);
  for (std::size_t e = 0; e < held_.size(); ++e) {
    const network::Event& event = program_.events()[e];
    const bool holds = program_.condition(e, workspace_);
    at_once[e] = holds && comes_at_once(e, t, x);
    const bool comes = holds && (!held_[e] || event.repeats || at_once[e]) && (!starting || event.at_start);
    held_[e] = holds;
    if (comes) served.push_back(e);
  }
  if (served.empty()) return false;
  if (!program_.signals(t, x.data(), signals_.data(), workspace_))
    throw loop_error(program_, workspace_.trouble(), t, file_);
  struct Change {
    const network::Event::Action* action;
    double value;
  };
  std::vector<Change> changes;
  for (std::size_t e : served) {
    const auto& set = program_.events()[e].actions;
    came_[e] = std::any_of(set.begin(), set.end(),
                           [](const network::Event::Action& action) { return action.on_state; });
    if (piles_up(e, t, at_once[e])) {
      came_[e] = false;
      e = *program_.events()[e].piling_up;
      record(t, program_.events()[e].block + ": its events pile up");
    } else {
      record(t, program_.events()[e].block);
    }
    const network::Event& event = program_.events()[e];
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
  set_ = set_ || std::any_of(changes.begin(), changes.end(),
                             [](const Change& change) { return change.action->on_state; });
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

}  // namespace oblique::solve
