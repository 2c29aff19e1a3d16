// SPDX-License-Identifier: MIT
#include <oblique/solve/events/switching.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/circle.h>
#include <oblique/solve/events/position_effects.h>
#include <oblique/solve/events/switching_start.h>
#include <oblique/solve/events/time_resolution.h>
#include <oblique/solve/readings/lone_states.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

constexpr int kMostRounds = 1000;  ///< of events that set each other off at one instant

/// Of 1 + its magnitude: an initial value that differs by less is the one that has been taken, as far as what
/// it follows from has come to rest.
constexpr double kSameStart = 1e-12;

}  // namespace

Switching::Switching(const network::Program& program, network::Workspace& workspace, double span,
                     double tolerance, double absolute_tolerance, const std::string& file)
    : program_(program),
      workspace_(workspace),
      file_(file),
      tolerance_(tolerance),
      log_(program, file),
      edges_(program, workspace, span),
      independent_(program),
      slide_(program, workspace, edges_, independent_, span),
      event_functions_(program, workspace, tolerance, absolute_tolerance, file),
      location_(program, workspace, slide_, event_functions_, span, file),
      settling_(program, workspace, slide_, independent_, event_functions_, location_.announced(), log_,
                span),
      resting_(program, workspace, slide_, event_functions_, location_.announced(), log_, span),
      wrong_sides_(program, workspace, slide_, settling_, event_functions_, log_, span),
      actions_(program, workspace, event_functions_, slide_, settling_, independent_, log_, span, file),
      faint_turns_(program, workspace, span),
      loop_jumps_(program, workspace, slide_, event_functions_.thresholds()),
      lone_states_(lone_states(program)) {
  loop_jumps_.begin();
}

void Switching::end_when(const Interruption& interruption) {
  interruption_ = interruption;
  event_functions_.end_when(interruption);
  location_.end_when(interruption);
}

void Switching::start(double t, std::vector<double>& x, const std::function<void()>& bring_to_rest,
                      bool loops_go) {
  const bool any_start =
      std::any_of(program_.states().begin(), program_.states().end(),
                  [](const network::State& state) { return state.start_node.has_value(); });
  // States take their starts again from what events change at this instant, until one sets states itself.
  bool starting = true, takes = any_start, first = true, has_gone = false;
  bool beside = false;   // of the guesses of loops at a corner
  bool last = false;     // loops go where everything else has settled
  bool several = false;  // positions agree, of which settling chooses the one after the other
  const auto take = [&] {
    const std::vector<double> before = x;
    try {
      take_starts(program_, workspace_, t, x, log_, file_);
    } catch (const SolveError& failure) {
      // A circle may be cut by a switch that does not stand where it belongs yet.
      if (!first || !active() || failure.kind() != SolveError::Kind::no_rest) throw;
      x = before;
      settling_.settle(t, x);
      settling_.begin();
      take_starts(program_, workspace_, t, x, log_, file_);
    }
  };
  // What has come to rest may be what states start from.
  std::vector<std::size_t> moving;
  const auto starts_move = [&] {
    const std::vector<double> before = x;
    take();
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (std::abs(x[i] - before[i]) > kSameStart * (1 + std::abs(x[i]))) moving.push_back(i);
    }
    if (moving.empty()) x = before;
    return !moving.empty();
  };
  const auto goes_on = [&] {
    moving.clear();
    settling_.begin();
    if (takes) take();
    if (active() && settling_.settle(t, x) && takes) return true;
    if (!first || !rests_within_limits(program_, workspace_, event_functions_, location_.announced(), t, x,
                                       bring_to_rest)) {
      slide_.put_at_rest(true);
      bring_to_rest();
      slide_.put_at_rest(false);
    }
    first = false;
    settling_.begin();
    if (takes && starts_move()) return true;
    if (active() && settling_.settle(t, x) && !several) return true;
    // What an event leads to may hang on where a loop goes before it.
    if (loops_go && !last && loop_jumps_.any()) {
      if (loop_jumps_.settle(t, x, false)) return true;
      if (active()) event_functions_.evaluate(t, x, location_.announced());
    }
    const auto effect = active() ? serve_events(t, x, starting) : std::nullopt;
    starting = starting && (!effect || effect->tables || effect->before_start);
    takes = takes && (!effect || !effect->sets_states);
    if (effect) {
      log_.forget_choices();
      return true;
    }
    return last && std::exchange(loops_go, false) && loop_jumps_.settle(t, x, false);
  };
  loop_jumps_.place_at_guesses(t, x);
  Circle circle;
  for (int round = 0;; ++round) {
    if (round > kMostRounds || circle.closes(workspace_.discrete_states(), x)) {
      // Loops may lead the events back that have led them on: they come last then. Tables may lead a loop in
      // a circle that begins where others did not stand yet.
      if (std::exchange(last, true) && (std::exchange(has_gone, true) || !loop_jumps_.go(t, x)) &&
          std::exchange(several, true)) {
        if (!moving.empty()) throw starts_in_circle(program_, moving, t, file_);
        throw log_.endless("the start does not settle", t);
      }
      circle = {};
      round = 0;
    }
    try {
      if (!goes_on()) break;
    } catch (const SolveError& failure) {
      // Where the switches in it stand for no signals yet, a loop may have no solution. (Nor where states
      // that start from signals are not there yet: where it would go then says nothing.)
      if (failure.kind() != SolveError::Kind::singular_loop) throw;
      if (!std::exchange(beside, true) && loop_jumps_.place_beside_guesses(t, x)) continue;
      if (any_start || std::exchange(has_gone, true) || !loop_jumps_.go(t, x)) throw;
    }
  }
  if (!active()) return;
  put_on_levels(t, x);
  settling_.tell_of_open(t, x);
  record_slides({}, {}, t, x);
  settling_.end({});
}

/// Calls `put` with the discrete state of each switch that is due, but of what slides, and its position then.
template <class Put>
void Switching::each_due(const Put& put) const {
  for (std::size_t s = 0; s < program_.switches().size(); ++s) {
    const auto due = announced_position(program_.switch_structure(), location_.announced(), s);
    if (due && !slide_.holds(s) && !slide_.follows(s)) put(program_.switches()[s].discrete_state, *due);
  }
}

/// Puts the switches that are due where they will be.
void Switching::put_what_is_due() {
  each_due([this](std::uint32_t state, double position) { workspace_.set_discrete_state(state, position); });
}

/// What is uncertain of each unit that slides, should it leave its switching surface: with the other switches
/// as they are and as those that are due will be (a limited integrator comes back where what drives it turns
/// over), or that its sides drive it apart as these will be.
std::vector<SlidingMode::Doubt> Switching::doubts_of_slide(double t, std::span<const double> x) {
  std::vector<SlidingMode::Doubt> doubts(slide_.units().size(), SlidingMode::Doubt::none);
  if (!slide_.active() || !slide_.evaluate(t, x)) return doubts;
  log_.look_along(slide_, t);
  for (std::size_t u = 0; u < doubts.size(); ++u) doubts[u] = slide_.doubt(u);
  const std::vector<double> before(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  put_what_is_due();
  const std::span<const double> after = workspace_.discrete_states();
  if (!std::equal(before.begin(), before.end(), after.begin(), after.end())) {
    const bool known = slide_.settle_sides(t, x) && slide_.evaluate(t, x);
    for (std::size_t u = 0; known && u < doubts.size(); ++u) {
      const SlidingMode::Doubt then = slide_.doubt(u);
      const std::uint32_t s = program_.switch_structure().members[slide_.units()[u]].front();
      const bool is_limit = !program_.switch_structure().masks[s].empty();  // it is left: no choice
      if (then == SlidingMode::Doubt::none || then == SlidingMode::Doubt::of_side ||
          (then == SlidingMode::Doubt::of_whether && !is_limit))
        doubts[u] = then;
    }
    workspace_.load_discrete_states(before);
    slide_.settle_sides(t, x);
    slide_.evaluate(t, x);
  }
  return doubts;
}

/// Serves the events that are due; nothing where there were none. Tables in an algebraic loop may lead each
/// other, or themselves, from line to line and back: then its elements find the lines.
std::optional<EventActions::Effect> Switching::serve_events(double t, std::vector<double>& x, bool starting) {
  constexpr int kManyHops = 40;
  const std::vector<double> before(event_functions_.values().begin(), event_functions_.values().end());
  auto effect = actions_.serve(t, x, starting);
  hops_ = effect && effect->tables ? hops_ + 1 : 0;
  if (!effect) return effect;
  if (hops_ == kManyHops) loop_jumps_.settle(t, x);
  settling_.begin_after_events(effect->events, effect->sets_states, effect->jumps, t, x);
  let_loops_go(t, x, [&] { event_functions_.evaluate(t, x, location_.announced()); });
  if (effect->jumps) event_functions_.take_slack_since(before);
  location_.withdraw_past(t, effect->jumps);
  return effect;
}

/// Records which of the announced switches have turned over; the solution leads the others back at once.
void Switching::record_turns(const std::vector<double>& before, double t) {
  for (std::uint32_t s = 0; s < event_functions_.size(); ++s) {
    const auto position = location_.announced()[s];
    if (!position) continue;
    const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
    if (workspace_.discrete_state(discrete_state) != before[discrete_state] || settling_.last_turn(s) == t ||
        (slide_.holds(s) && !slide_.is_silent(s)))
      log_.record_turn(s, *position, t);
    else
      settling_.let_touch(s);
  }
}

/// Records which units have begun and ended to slide since those of `before` did, and tells what is uncertain
/// of that: also what reads a level at which a limit holds something.
void Switching::record_slides(const std::vector<std::uint32_t>& before,
                              const std::vector<SlidingMode::Doubt>& doubts, double t,
                              std::span<const double> x) {
  log_.record_slides(before, doubts, slide_, t);
  if (slide_.units() == before || !slide_.active() || !slide_.evaluate(t, x)) return;
  for (std::size_t u = 0; u < slide_.units().size(); ++u) {
    const std::uint32_t unit = slide_.units()[u];
    const auto above = slide_.rests_above(u);
    if (!above || std::find(before.begin(), before.end(), unit) != before.end()) continue;
    if (const auto idle = idle_on_side(program_, workspace_, unit, *above, t, x)) log_.warn_of_held(*idle, t);
  }
}

/// Does something for which the loops must have solutions. Where one has none on the side of its own switches
/// on which it was, as q|q| + q = u where u jumps from 1 to −1, it goes where its elements take it, with what
/// is due where it will be.
template <class Action>
void Switching::let_loops_go(double t, std::span<const double> x, const Action& action) {
  try {
    action();
  } catch (const SolveError& failure) {
    const bool of_loop =
        failure.kind() == SolveError::Kind::singular_loop || failure.kind() == SolveError::Kind::chatter;
    if (!of_loop || !loop_jumps_.any()) throw;
    put_what_is_due();
    if (!loop_jumps_.go(t, x)) throw;
    settling_.begin();
    action();
  }
}

/// All switches, and the loops between them, where nothing has been served yet that follows from them.
void Switching::settle_switches(double t, std::span<const double> x) {
  let_loops_go(t, x, [&] { settling_.settle(t, x); });
  if (!loop_jumps_.any()) return;
  if (loop_jumps_.settle(t, x)) settling_.settle(t, x);
  event_functions_.evaluate(t, x, location_.announced());
}

void Switching::settle(double t, std::vector<double>& x) {
  const std::vector<std::uint32_t> slid = slide_.units();
  const std::vector<SlidingMode::Doubt> doubts = doubts_of_slide(t, x);
  for (std::size_t u = 0; u < doubts.size(); ++u) {
    // What could as well stay goes where it is driven.
    const auto above = slide_.rests_above(u);
    if (above && doubts[u] == SlidingMode::Doubt::of_whether) slide_.show(u, !*above);
  }
  loop_jumps_.note(t, x);
  each_due([this](std::uint32_t state, double position) { loop_jumps_.expect(state, position); });
  if (location_.slide_changes()) {
    settling_.watch_followers(t);
    settling_.begin();
  } else {
    settling_.begin_beside_slides(t, x);
  }
  event_functions_.evaluate(t, x, location_.announced());
  settling_.begin_instant();
  location_.withdraw_early(t);
  const std::vector<double> before(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  std::vector<FaintTurn> faint = faint_turns_.due(t, location_.announced(), event_functions_,
                                                  [this](std::uint32_t s) { return settling_.last_turn(s); });
  const std::vector<double> before_turns = faint.empty() ? std::vector<double>() : readings(t, x);
  if (before_turns.empty()) faint.clear();
  actions_.begin_instant();
  resting_.begin_instant();
  for (int round = 0;; ++round) {
    settle_switches(t, x);
    if (round == 0) record_turns(before, t);
    resting_.look(t, x);
    if (!serve_events(t, x, false) && !resting_.lower(t, x)) break;
    if (round > kMostRounds) throw log_.endless("events set each other off", t);
  }
  put_on_levels(t, x);
  record_slides(slid, doubts, t, x);
  settling_.end(slid);
  location_.withdraw_all();
  event_functions_.evaluate(t, x, location_.announced());
  wrong_sides_.allow();
  if (faint.empty()) return;
  const std::vector<double> after_turns = readings(t, x);
  if (!after_turns.empty()) faint_turns_.keep(std::move(faint), before_turns, after_turns);
}

/// Puts a state onto the switching surface along which it slides, where that is a level of it alone: there it
/// stands. Where it stood when the slide began, a rounding or so beside it, others would integrate for as
/// long as it lasts.
void Switching::put_on_levels(double t, std::vector<double>& x) {
  constexpr double kBeside = 1e-9;  // [machine unit]
  still_.clear();
  const std::vector<std::uint32_t>& units = slide_.units();
  const bool any = std::any_of(units.begin(), units.end(),
                               [&](std::uint32_t unit) { return lone_states_[unit].has_value(); });
  if (!any || !slide_.evaluate(t, x)) return;
  for (std::size_t u = 0; u < units.size(); ++u) {
    const std::uint32_t unit = units[u];
    const std::optional<std::size_t> state = lone_states_[unit];
    if (!state) continue;
    const std::uint32_t s = program_.switch_structure().members[unit].front();
    const network::Evaluation& here = evaluate(t, x);
    std::vector<double> rates(x.size(), 0.0), moving(program_.switches().size()), still(moving.size());
    here.event_function_rates(rates.data(), still.data());
    rates[*state] = 1;
    here.event_function_rates(rates.data(), moving.data());
    const double moved = moving[s] - still[s], off = event_functions_[s] / moved;
    const double beside = kBeside + off_at_zero(t, slide_.fastest_drive(u) / moved);
    if (still[s] != 0 || !(std::abs(off) < beside)) continue;
    if (!slide_.is_held(u) && !slide_.comes_back(u, *state, t, x)) continue;
    x[*state] -= off;
    still_.push_back(*state);
  }
  if (!still_.empty()) event_functions_.evaluate(t, x, location_.announced());
}

/// All signals and what events keep; nothing where the signals have no values.
std::vector<double> Switching::readings(double t, std::span<const double> x) {
  std::vector<double> values(program_.n_signals());
  if (!signals(t, x.data(), values.data())) return {};
  faint_turns_.add_memories(values);
  return values;
}

std::vector<bool> Switching::sliding() const {
  std::vector<bool> sliding(program_.switches().size());
  for (std::size_t s = 0; s < sliding.size(); ++s) sliding[s] = slide_.holds(s) || slide_.rests(s);
  return sliding;
}

void Switching::resume(double t, std::vector<double>& x) {
  event_functions_.evaluate(t, x, location_.announced());
  settling_.keep_positions_within_errors();
  settle(t, x);
}

void Switching::throw_endless(double t) const {
  throw log_.endless("a comparison of the time is always due", t);
}

std::optional<double> Switching::search(double from, std::span<const double> sample_times,
                                        const Interpolant& solution) {
  auto found = location_.search(from, sample_times, solution);
  if (event_functions_.thresholds().lets_any()) {
    if (look_at_hidden(found ? found->time : sample_times.back(), solution) && !found)
      found = location_.search(from, sample_times, solution);
  }
  for (const EventSearch::NearMiss& miss : location_.near_misses()) look_at_miss(miss, solution);
  if (!found) return std::nullopt;
  faint_turns_.approach(from, found->time, found->turned, solution);
  return found->time;
}

const Interpolant& Switching::looked_at(double t, const Interpolant& solution) {
  constexpr double kNear = 1e4;  // tolerances of a machine unit
  if (program_.switches().empty() || !event_functions_.any_step() ||
      !(location_.nearest() < kNear * tolerance_))
    return solution;
  std::vector<double> x(program_.n_states());
  solution.states_at(t, x);
  workspace_.pass_failing_loops(true);  // the branch of one may end within the step
  event_functions_.evaluate(t, x, location_.announced());
  workspace_.pass_failing_loops(false);
  return event_functions_.within_step(solution);
}

/// Looks at t at what lies on the wrong side by less than an error that it had at another time: whether that
/// is more than it has now, so that an event has been overlooked.
bool Switching::look_at_hidden(double t, const Interpolant& solution) {
  std::vector<double> x(program_.n_states());
  solution.states_at(t, x);
  event_functions_.evaluate(t, x, location_.announced());
  const bool overlooked = event_functions_.any_step() && wrong_sides_.limit_slack();
  if (!overlooked) wrong_sides_.tell(resting_, t, x);
  event_functions_.evaluate(t, x, location_.announced());  // back to the solutions of the loops
  return overlooked;
}

/// Keeps a top of an event function as a faint turn where it is nearer to zero than its errors, and the turn
/// would have had an effect.
void Switching::look_at_miss(const EventSearch::NearMiss& miss, const Interpolant& solution) {
  const std::uint32_t s = miss.number;
  if (program_.switches()[s].turning != network::Turning::jumps || slide_.holds(s) || slide_.follows(s) ||
      slide_.rests(s) || faint_turns_.is_known(s) ||
      is_masked(program_.switch_structure().masks[s], workspace_.discrete_states()))
    return;
  std::vector<double> x(program_.n_states());
  solution.states_at(miss.time, x);
  event_functions_.evaluate(miss.time, x, location_.announced());
  const EventFunctionErrors& errors = event_functions_.weigh_errors();
  if (!faint_turns_.comes_from_afar(event_functions_[s], errors[s],
                                    event_functions_.thresholds().excursion(s),
                                    miss.time - settling_.last_turn(s)))
    return;
  const double error = std::max(errors[s], std::abs(event_functions_[s]));
  FaintTurn turn{s, miss.time, error, false, event_functions_.states_behind(s)};
  const auto looked = [&] {
    std::vector<double> values = readings(miss.time, x);
    if (values.empty()) return values;
    const network::Evaluation& here = evaluate(miss.time, x);
    for (std::size_t e = 0; e < program_.events().size(); ++e) values.push_back(here.condition(e) ? 1 : 0);
    return values;
  };
  const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
  const double position = workspace_.discrete_state(discrete_state);
  const std::vector<double> before = looked();
  workspace_.set_discrete_state(discrete_state, 1 - position);
  const std::vector<double> after = looked();
  workspace_.set_discrete_state(discrete_state, position);
  event_functions_.evaluate(miss.time, x, location_.announced());  // back to the solutions of the loops
  if (!before.empty() && !after.empty()) faint_turns_.keep({std::move(turn)}, before, after);
}

const network::Evaluation& Switching::evaluate(double t, std::span<const double> x) {
  event_functions_.evaluate(t, x, location_.announced());
  return event_functions_.here();
}

/// Calls `evaluate` at t; on an edge of the segment where some of the values are none, a moment inside.
template <class Evaluate>
bool Switching::inside(double t, std::span<const double> values, const Evaluate& evaluate) const {
  const double near = time_resolution(t);
  const bool at_begin = t - begin_ <= near, at_end = end_ - t <= near;  // both, of one as short as a rounding
  if (!at_begin && !at_end) return evaluate(t);
  const auto has_values = [&](double at) {
    return evaluate(at) &&
           std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  for (const double distance : {0, 2, 16}) {
    if ((at_begin && has_values(t + distance * near)) || (at_end && has_values(t - distance * near)))
      return true;
  }
  return evaluate(t);
}

bool Switching::derivatives(double t, const double* x, double* dxdt) {
  const std::span<double> values(dxdt, program_.n_states());
  if (slide_.active()) {
    const bool known = inside(t, values, [&](double at) { return slide_.derivatives(at, x, dxdt); });
    for (const std::size_t i : still_) dxdt[i] = 0;
    return known;
  }
  if (!inside(t, values, [&](double at) { return program_.derivatives(at, x, dxdt, workspace_); }))
    return false;
  edges_.complete_derivatives(t, x, values);
  return true;
}

bool Switching::way_back(double t, const double* x, double h, double* change) {
  if (!slide_.active() || !slide_.way_back(t, x, h, change)) return false;
  for (const std::size_t i : still_) change[i] = 0;
  return true;
}

void Switching::mark_held(double t, const double* x, std::vector<bool>& held) {
  if (!slide_.active() || slide_.units() == marked_) return;
  std::vector<double> values(program_.switches().size()), still(values.size());
  const auto here = program_.event_functions(t, x, values.data(), workspace_);
  if (!here) return;
  marked_ = slide_.units();
  std::vector<double> rates(program_.n_states(), 0.0);
  here->event_function_rates(rates.data(), still.data());
  for (std::size_t i = 0; i < rates.size(); ++i) {
    rates[i] = 1;
    here->event_function_rates(rates.data(), values.data());
    rates[i] = 0;
    for (const std::uint32_t unit : marked_) {
      const std::uint32_t s = program_.switch_structure().members[unit].front();
      if (values[s] != still[s]) held[i] = true;
    }
  }
}

/// Makes the derivatives of the states that stand zero.
void Switching::stand_rows(std::span<double> entries) const {
  const network::SparsePattern& pattern = program_.jacobian_pattern();
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto row = static_cast<std::size_t>(pattern.rows[k]);
    if (std::find(still_.begin(), still_.end(), row) != still_.end()) entries[k] = 0;
  }
}

bool Switching::jacobian(double t, const double* x, double* values) {
  const std::span<double> entries(values, program_.jacobian_pattern().entries());
  if (slide_.active()) {
    const bool known = inside(t, entries, [&](double at) { return slide_.jacobian(at, x, values); });
    // What stands does so whatever the states are: by the derivatives of an amplifier at its limit, which are
    // large, Newton's method would leave it where it was led to.
    if (!still_.empty()) stand_rows(entries);
    return known;
  }
  if (!inside(t, entries, [&](double at) { return program_.jacobian(at, x, values, workspace_); }))
    return false;
  edges_.complete_jacobian(t, x, entries);
  return true;
}

bool Switching::signals(double t, const double* x, double* values) {
  interruption_.check();
  const std::span<double> all(values, program_.n_signals());
  if (slide_.active()) return inside(t, all, [&](double at) { return slide_.signals(at, x, values); });
  if (!inside(t, all, [&](double at) { return program_.signals(at, x, values, workspace_).has_value(); }))
    return false;
  edges_.complete_signals(t, x, all);
  return true;
}

}  // namespace oblique::solve
