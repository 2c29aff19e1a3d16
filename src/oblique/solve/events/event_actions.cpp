// SPDX-License-Identifier: MIT
#include <oblique/solve/events/event_actions.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

bool sets_states(const network::Event& event) {
  return std::any_of(event.actions.begin(), event.actions.end(),
                     [](const network::Event::Action& action) { return action.on_state; });
}

}  // namespace

EventActions::EventActions(const network::Program& program, network::Workspace& workspace,
                           const EventFunctions& event_functions, const SlidingMode& slide,
                           const SwitchSettling& settling, IndependentUnits& independent, EventLog& log,
                           double span, const std::string& file)
    : program_(program),
      workspace_(workspace),
      event_functions_(event_functions),
      slide_(slide),
      settling_(settling),
      independent_(independent),
      log_(log),
      span_(span),
      file_(file),
      held_(program.events().size(), false),
      came_(program.events().size(), false),
      paces_(program.events().size()),
      uncertain_(program, workspace, slide, log, file),
      signals_(program.n_signals()),
      movers_(program.events().size()) {
  for (std::uint32_t s = 0; s < program.switches().size(); ++s) {
    if (const auto event = program.switches()[s].moves_along) movers_[*event].push_back(s);
  }
}

/// Whether events come ever faster at t that know what they go over into: others may follow them.
bool EventActions::is_any_to_pile_up(double t) const {
  for (std::size_t e = 0; e < paces_.size(); ++e) {
    const EventPace& pace = paces_[e];
    if (program_.events()[e].piling_up && pace.shorter > 0 && t - pace.last <= *pace.interval) return true;
  }
  return false;
}

/// Whether an event shows Zeno behaviour, so that the one that takes its place is to come. Throws SolveError
/// where none does. A table's segments follow what it reads, and make no end.
bool EventActions::is_zeno(const Come& come, double t) {
  const network::Event& what = program_.events()[come.event];
  if (what.repeats) return false;
  look_for_lost(come.event, t);
  const auto zeno = paces_[come.event].come(t, span_, end_);
  // Where a ball bounces by its errors, in no rhythm, it has come to rest.
  constexpr int kMostTiny = 1000;
  const bool by_errors = what.piling_up && paces_[come.event].tiny > kMostTiny;
  if (!zeno && !come.at_once && !by_errors) return false;
  if (what.piling_up) {
    piled_up_ = t;
    return true;
  }
  if (!come.at_once && is_any_to_pile_up(t)) return false;
  const std::string told =
      zeno
          ? fmt::format(
                "come ever faster: at t = {:.9g} s again after {:.3g} s, and they pile up at t = "
                "{:.9g} s",
                t, zeno->interval, zeno->at)
          : fmt::format("come again at once at t = {:.9g} s: what they set leads back to their condition", t);
  throw SolveError(SolveError::Kind::chatter, t,
                   {{file_, {}},
                    fmt::format("the events of '{}' {}", what.block, told),
                    {},
                    "end the run before, or tell the block what happens there: 'piling_up' beside 'set' in "
                    "its [[events]]"});
}

/// What piles up goes on to, until nobody can tell one event from the next: where it had not come again at t,
/// long after, it has been lost in the errors of the states.
void EventActions::look_for_lost(std::size_t event, double t) {
  constexpr double kLong = 10;  // times as long as it would have taken
  const EventPace& pace = paces_[event];
  if (told_of_lost_ || !pace.due || piled_up_ >= pace.last || !sets_states(program_.events()[event]) ||
      !(t > *pace.due + kLong * (*pace.due - pace.last)))
    return;
  told_of_lost_ = true;
  log_.warn({{file_, {}},
             fmt::format(
                 "the events of '{}' came ever faster, at last at t = {:.9g} s after {:.3g} s, to pile "
                 "up at t = {:.9g} s; then the errors of the states hid them, and what follows may be wrong",
                 program_.events()[event].block, pace.last, pace.interval.value_or(0), *pace.due),
             {},
             "end the run before, or tell the block what happens there: 'piling_up' beside 'set' in its "
             "[[events]]"});
}

void EventActions::end(double t) {
  for (std::size_t e = 0; e < paces_.size(); ++e) look_for_lost(e, t);
}

/// Whether something that came at this instant has set what the event function of a switch ever depends on.
bool EventActions::is_led_by_what_came(std::size_t s) {
  const std::uint32_t unit = program_.switch_structure().unit[s];
  for (std::size_t e = 0; e < came_.size(); ++e) {
    if (came_[e] && independent_.acts(program_.events()[e], unit)) return true;
  }
  return false;
}

/// Whether the condition of an event that came at this instant holds because what it set leads back to it: it
/// hangs on a switch whose event function is at zero, and neither stays there nor leaves that side (a ball
/// that bounces where something else has its event). (Once states have jumped, at zero to rounding: what has
/// only just passed it, and lies within its errors, the jump has not led there.)
bool EventActions::comes_at_once(std::size_t event, double t, std::span<const double> x) {
  if (!came_[event]) return false;
  std::vector<double> others(event_functions_.size()), rates(event_functions_.size());
  if (const auto here = program_.event_functions(t, x.data(), others.data(), workspace_)) {
    std::vector<double> derivatives(program_.n_states());
    here->derivatives(derivatives.data());
    here->event_function_rates(derivatives.data(), rates.data());
  }
  bool hangs = false;
  for (std::size_t s = 0; s < event_functions_.size() && !hangs; ++s) {
    if (event_functions_.is_known(s) || settling_.stays(s) || slide_.rests(s) ||
        event_functions_.is_off_zero(s) ||
        (jumped_ && std::abs(event_functions_[s]) > event_functions_.thresholds().rounding(s)))
      continue;
    const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
    const double position = workspace_.discrete_state(discrete_state);
    if (position == 1 ? rates[s] < 0 : rates[s] > 0) continue;  // on its way to the other side
    if (!is_led_by_what_came(s)) continue;
    workspace_.set_discrete_state(discrete_state, 1 - position);
    const auto there = program_.event_functions(t, x.data(), others.data(), workspace_);
    hangs = there && !there->condition(event);
    workspace_.set_discrete_state(discrete_state, position);
  }
  program_.event_functions(t, x.data(), others.data(),
                           workspace_);  // back to the solutions of the loops here
  return hangs;
}

/// Whether a table follows what slides: it goes along on each of its sides.
bool EventActions::is_of_slide(std::size_t event) const {
  const std::vector<std::uint32_t>& movers = movers_[event];
  return std::any_of(movers.begin(), movers.end(), [&](std::uint32_t s) { return slide_.follows(s); });
}

/// Looks at all conditions; the events that have come. While tables are moved along nothing else comes: on
/// the way to the segment that belongs to it a table gives values that are nobody's.
std::vector<EventActions::Come> EventActions::look(double t, std::span<const double> x, bool starting) {
  std::vector<Come> tables;
  for (std::size_t e = 0; e < held_.size(); ++e) {
    if (program_.events()[e].repeats && !is_of_slide(e) && event_functions_.here().condition(e))
      tables.push_back({e, false});
  }
  if (!tables.empty()) return tables;
  const std::vector<bool> held_before = held_;
  for (std::size_t e = 0; e < held_.size(); ++e) held_[e] = event_functions_.here().condition(e);
  std::vector<Come> found;
  for (std::size_t e = 0; e < held_.size(); ++e) {
    const network::Event& event = program_.events()[e];
    const bool at_once = held_[e] && comes_at_once(e, t, x);
    const bool comes =
        held_[e] && !event.repeats && (!held_before[e] || at_once) && (!starting || event.at_start);
    if (comes) found.push_back({e, at_once});
  }
  // At a start what was so before it comes first; what follows from that does not rise.
  const auto of_before = [&](const Come& come) { return program_.events()[come.event].before_start; };
  if (!starting || std::none_of(found.begin(), found.end(), of_before)) return found;
  for (const Come& come : found) held_[come.event] = of_before(come);
  std::erase_if(found, [&](const Come& come) { return !of_before(come); });
  return found;
}

/// What an event sets, by the signals `here`.
void EventActions::add_changes(std::size_t event, const network::SignalEvaluation& here, double t,
                               std::vector<Change>& changes) const {
  const network::Event& what = program_.events()[event];
  for (std::size_t a = 0; a < what.actions.size(); ++a) {
    const double value = here.action_value(event, a);
    if (!std::isfinite(value)) {
      throw SolveError(SolveError::Kind::blow_up, t,
                       {{file_, {}},
                        fmt::format("an event of '{}' would set a value that is no finite number at t = "
                                    "{:.6g} s",
                                    what.block, t),
                        {},
                        {}});
    }
    changes.push_back({&what.actions[a], value});
  }
}

/// What a mode puts to initial values may start from others that it puts there at the same instant: these are
/// taken again from the signals as they then are, one after the other.
void EventActions::put_in_chain(const std::vector<std::size_t>& events, double t, std::vector<double>& x) {
  const auto of_mode = [&](std::size_t event) { return program_.events()[event].of_mode; };
  std::vector<std::size_t> chain;
  std::copy_if(events.begin(), events.end(), std::back_inserter(chain), of_mode);
  bool changes = chain.size() > 1;
  for (std::size_t round = 0; changes && round < chain.size(); ++round) {
    workspace_.pass_failing_loops(true);
    const auto here = program_.signals(t, x.data(), signals_.data(), workspace_);
    workspace_.pass_failing_loops(false);
    if (!here) return;
    std::vector<Change> put;
    for (const std::size_t event : chain) add_changes(event, *here, t, put);
    changes = false;
    for (const Change& change : put) {
      if (!change.action->on_state || x[change.action->index] == change.value) continue;
      x[change.action->index] = change.value;
      changes = true;
    }
  }
}

std::optional<EventActions::Effect> EventActions::serve(double t, std::vector<double>& x, bool starting) {
  const std::vector<Come> served = look(t, x, starting);
  if (served.empty()) return std::nullopt;
  // A loop may have no solution until tables are moved along, or memories have changed, that it reads.
  workspace_.pass_failing_loops(true);
  const auto here = program_.signals(t, x.data(), signals_.data(), workspace_);
  workspace_.pass_failing_loops(false);
  if (!here) throw loop_error(program_, workspace_.trouble(), t, file_);
  std::vector<Change> changes;
  std::vector<std::size_t> events;
  for (const Come& come : served) {
    const network::Event& event = program_.events()[come.event];
    came_[come.event] = sets_states(event);
    if (is_zeno(come, t)) {
      came_[come.event] = false;
      log_.record(t, program_.events()[*event.piling_up].block + ": its events pile up");
      events.push_back(*event.piling_up);
    } else {
      log_.record(t, event.block);
      events.push_back(come.event);
    }
    add_changes(events.back(), *here, t, changes);
  }
  if (!starting) {
    std::vector<double> values(changes.size());
    std::transform(changes.begin(), changes.end(), values.begin(),
                   [](const Change& change) { return change.value; });
    uncertain_.look(events, values, t, x);
  }
  Effect effect;
  effect.events = events;
  served_.insert(served_.end(), events.begin(), events.end());
  effect.tables = program_.events()[served.front().event].repeats;
  effect.before_start = starting && program_.events()[served.front().event].before_start;
  const std::vector<double> before = x;
  for (const Change& change : changes) {
    if (change.action->on_state) {
      effect.sets_states = true;
      x[change.action->index] = change.value;
    } else {
      workspace_.set_discrete_state(change.action->index, change.value);
    }
  }
  put_in_chain(events, t, x);
  effect.jumps = x != before;
  jumped_ = jumped_ || effect.jumps;
  return effect;
}

}  // namespace oblique::solve
