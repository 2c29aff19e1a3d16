// SPDX-License-Identifier: MIT
#include <oblique/solve/events/wrong_sides.h>

#include <oblique/solve/events/position_effects.h>

namespace oblique::solve {
namespace {

constexpr double kSurely = 30;  ///< errors
constexpr double kClearly = 3;  ///< where it stays so for long

}  // namespace

WrongSides::WrongSides(const network::Program& program, network::Workspace& workspace,
                       const SlidingMode& slide, const SwitchSettling& settling,
                       EventFunctions& event_functions, EventLog& log, double span)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      settling_(settling),
      event_functions_(event_functions),
      log_(log),
      span_(span),
      told_(program.switch_structure().members.size(), false),
      clearly_since_(program.switches().size()),
      cuts_(program.switches().size(), 0) {}

void WrongSides::allow() {
  Thresholds& thresholds = event_functions_.thresholds();
  for (std::size_t s = 0; s < event_functions_.size(); ++s) {
    if (event_functions_.is_known(s) || slide_.holds(s) || slide_.follows(s)) continue;
    const double wrong = event_functions_.against(s);
    if (wrong > thresholds[s]) thresholds.widen(s, 2 * wrong);
  }
}

bool WrongSides::limit_slack() {
  // What turns over and back by rounding would be cut and turn at every instant that a number can tell.
  constexpr int kMostCuts = 4;  // in a step
  Thresholds& thresholds = event_functions_.thresholds();
  const EventFunctionErrors& errors = event_functions_.weigh_errors();
  bool any = false;
  for (std::size_t s = 0; s < event_functions_.size(); ++s) {
    if (!thresholds.let_since(s) || cuts_[s] >= kMostCuts) continue;
    if (!steps_damp_ && !(errors[s] < errors.undamped(s))) continue;
    // One that was announced and did not turn over would be announced again at once, before it is far away.
    const auto touch = settling_.touch(s);
    thresholds.limit_slack(s, touch ? kSurely * std::max(errors[s], *touch) : errors[s]);
    if (event_functions_.against(s) <= thresholds.along_solution(s, thresholds.rounding(s))) continue;
    ++cuts_[s];
    any = true;
  }
  return any;
}

void WrongSides::tell(const RestingComparisons& resting, double t, std::span<const double> x) {
  constexpr double kLong = 1e-3;  // of the run: what is late by less shows in no output
  const EventFunctionErrors& errors = event_functions_.weigh_errors();
  for (std::uint32_t s = 0; s < event_functions_.size(); ++s) {
    const std::uint32_t unit = program_.switch_structure().unit[s];
    const auto since = event_functions_.thresholds().let_since(s);
    // What has not turned over yet, or was looked at and let touch, is a decay, which stays on its side,
    // unless it goes on to the other one, far or for long.
    const auto touch = settling_.touch(s);
    const double beyond = since ? event_functions_.against(s) / std::max(errors[s], touch.value_or(0)) : 0;
    if (!(beyond > kClearly)) clearly_since_[s].reset();
    if (beyond > kClearly && !clearly_since_[s]) clearly_since_[s] = t;
    if (!since || told_[unit] || !(t - *since > kLong * span_)) continue;
    const bool surely = beyond > kSurely || (clearly_since_[s] && t - *clearly_since_[s] > kLong * span_);
    if (resting.contains(unit) || ((settling_.last_turn(s) == 0 || touch) && !surely)) continue;
    if (!changes_signals(program_, workspace_, unit, t, x) &&
        !changes_rates(program_, workspace_, unit, t, x))
      continue;
    told_[unit] = true;
    const bool holds = workspace_.discrete_state(program_.switches()[s].discrete_state) == 1;
    log_.warn_of_hidden(s, holds, *since, t, surely ? errors.undamped(s) : errors[s]);
  }
}

}  // namespace oblique::solve
