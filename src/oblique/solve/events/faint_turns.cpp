// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/events/faint_turns.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::solve {
namespace {

constexpr double kAfar = 30;            ///< errors
constexpr double kShortestTurn = 1e-4;  ///< of the run: turns that come more quickly may be those of a ball

/// Whether so much more than errors of this size lies between two values of the signals: a kink, also behind
/// a high gain, changes them by some errors, unless these are so large that what they do cannot be told.
bool jumps(const std::vector<double>& before, const std::vector<double>& after, double error) {
  constexpr double kTimes = 1e4, kLeast = 1e-6, kClear = 0.03;  // of the errors; of 1 + the signal, twice
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double jump = std::abs(after[i] - before[i]), size = 1 + std::abs(before[i]);
    if (jump > kLeast * size && jump > std::min(kTimes * error, kClear * size)) return true;
  }
  return false;
}

}  // namespace

FaintTurns::FaintTurns(const network::Program& program, network::Workspace& workspace, double span)
    : program_(program),
      workspace_(workspace),
      span_(span),
      farthest_(program.switches().size(), 0.0),
      states_(program.n_states()),
      rates_(program.n_states()),
      event_functions_(program.switches().size()),
      event_function_rates_(program.switches().size()) {
  for (const network::Event& event : program.events()) {
    for (const network::Event::Action& action : event.actions) {
      if (!action.on_state && !event.repeats) memories_.push_back(action.index);
    }
  }
}

void FaintTurns::approach(double from, double at, const std::vector<std::pair<std::uint32_t, double>>& turned,
                          const Interpolant& solution) {
  approaches_.clear();
  for (const auto& [s, position] : turned) {
    if (!program_.switches()[s].rate) approaches_.push_back({s});  // the others follow the time alone
  }
  if (approaches_.empty() || states_.empty()) return approaches_.clear();
  if (!evaluate(from, solution)) return approaches_.clear();
  for (Approach& a : approaches_) {
    a.before = std::abs(event_functions_[a.number]);
    a.overshoot = event_function_rates_[a.number];
  }
  if (!evaluate(at, solution)) return approaches_.clear();
  for (Approach& a : approaches_) {
    const double rate = event_function_rates_[a.number];
    const double deceleration = (a.overshoot - rate) / (at - from) * (rate > 0 ? 1 : -1);
    a.speed = std::abs(rate);
    a.overshoot =
        deceleration > 0 ? rate * rate / (2 * deceleration) : std::numeric_limits<double>::infinity();
  }
}

/// All event functions and their rates along a solution.
bool FaintTurns::evaluate(double t, const Interpolant& solution) {
  solution.states_at(t, states_);
  solution.rates_at(t, rates_);
  const auto there = program_.event_functions(t, states_.data(), event_functions_.data(), workspace_);
  if (there) there->event_function_rates(rates_.data(), event_function_rates_.data());
  return there.has_value();
}

bool FaintTurns::is_known(std::uint32_t s) const {
  return std::any_of(found_.begin(), found_.end(), [s](const FaintTurn& turn) { return turn.number == s; });
}

bool FaintTurns::comes_from_afar(double event_function, double error, double excursion, double since) const {
  constexpr double kMisses = 100;  // errors, which may come together in a long run
  const double size = std::abs(event_function);
  return size <= kMisses * error && excursion >= kAfar * std::max(error, size) &&
         since >= kShortestTurn * span_;
}

/// At t, by the error of the event function, how far it has been from zero since it turned over last, and
/// when that was [s]; 0 where it never has.
bool FaintTurns::is_faint(const Approach& approach, double error, double excursion, double t,
                          double last_turn) const {
  const double since = t - last_turn;
  constexpr double kNear = 10;           // errors
  constexpr double kSlow = 1000;         // errors: a decay to within them takes some 30 of its times
  constexpr double kStandsStill = 1e-5;  // of the excursion: short steps make much of their errors
  const bool is_near = excursion <= kNear * error;
  const bool is_slow = approach.speed * since <= std::max(kSlow * error, kStandsStill * excursion);
  const bool has_decayed =
      is_near && farthest_[approach.number] >= kAfar * error && since >= kShortestTurn * span_;
  const bool never_left = is_near && is_slow && last_turn == 0;  // what a step sets off at a rest is not slow
  // What does not slow down comes back at least as fast as it went away: the short flights of a ball.
  const bool decays = excursion >= kAfar * error && is_slow && approach.speed * since < excursion;
  const bool touches = excursion >= kAfar * error && approach.overshoot <= kAfar * error;
  return (approach.before <= error && (decays || has_decayed || never_left)) || touches;
}

std::vector<FaintTurn> FaintTurns::due(double t, const Announced& announced, EventFunctions& event_functions,
                                       const std::function<double(std::uint32_t)>& last_turn) {
  if (approaches_.empty()) return {};
  const EventFunctionErrors& errors = event_functions.weigh_errors();
  std::vector<FaintTurn> found;
  for (const Approach& approach : approaches_) {
    const std::uint32_t s = approach.number;
    const double excursion = event_functions.thresholds().excursion(s);
    farthest_[s] = std::max(farthest_[s], excursion);
    // (What follows the time alone has no error.)
    if (errors[s] > 0 && !is_known(s) && announced[s] &&
        is_faint(approach, errors[s], excursion, t, last_turn(s)))
      found.push_back({s, t, errors[s], true, event_functions.states_behind(s)});
  }
  approaches_.clear();
  return found;
}

void FaintTurns::add_memories(std::vector<double>& signals) const {
  for (const std::uint32_t m : memories_) signals.push_back(workspace_.discrete_state(m));
}

void FaintTurns::keep(std::vector<FaintTurn> turns, const std::vector<double>& before,
                      const std::vector<double>& after) {
  for (FaintTurn& turn : turns) {
    if (jumps(before, after, turn.error)) found_.push_back(std::move(turn));
  }
}

}  // namespace oblique::solve
