// SPDX-License-Identifier: MIT
#include <oblique/solve/events/resting_comparisons.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <oblique/solve/events/position_effects.h>
#include <oblique/solve/events/position_limits.h>
#include <oblique/solve/events/self_consistent.h>

namespace oblique::solve {

RestingComparisons::RestingComparisons(const network::Program& program, network::Workspace& workspace,
                                       const SlidingMode& slide, EventFunctions& event_functions,
                                       const Announced& announced, EventLog& log, double span)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      event_functions_(event_functions),
      announced_(announced),
      log_(log),
      level_rest_(program, workspace, slide, event_functions.thresholds(), span),
      signals_(program.n_signals()),
      derivatives_(program.n_states()),
      rates_(program.switches().size()),
      event_functions_turned_(program.switches().size()) {}

void RestingComparisons::begin_instant() {
  const network::SwitchStructure& structure = program_.switch_structure();
  came_.clear();
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (!announced_[s]) continue;
    const std::uint32_t unit = structure.unit[s];
    came_.push_back({unit, event_functions_[structure.members[unit].front()]});
  }
}

/// Whether a comparison of a unit holds which is where it was when this instant began, within what its time
/// is known to of its level.
bool RestingComparisons::holds_at_level(const Came& came) const {
  const auto& members = program_.switch_structure().members[came.unit];
  const std::uint32_t s = members.front();
  if (event_functions_.is_known(s) || slide_.holds(s) || slide_.follows(s)) return false;
  const bool holds = std::any_of(members.begin(), members.end(), [&](std::uint32_t m) {
    const network::Switch& made = program_.switches()[m];
    return workspace_.discrete_state(made.discrete_state) == 1 && made.turning == network::Turning::jumps;
  });
  return holds && event_functions_[s] == came.event_function &&
         std::abs(event_functions_[s]) <= SlidingMode::drift();
}

/// Whether the event function of a unit, evaluated last, stays where it is by its rate.
bool RestingComparisons::stands_still(std::uint32_t unit) {
  const std::uint32_t s = program_.switch_structure().members[unit].front();
  event_functions_.here().derivatives(derivatives_.data());
  event_functions_.here().event_function_rates(derivatives_.data(), rates_.data());
  return level_rest_.stands_still(s, rates_[s]);
}

bool RestingComparisons::lower(double t, std::span<const double> x) {
  for (const Came& came : came_) {
    if (!holds_at_level(came)) continue;
    event_functions_.evaluate(t, x, announced_);
    if (!stands_still(came.unit)) continue;
    std::vector<double> turned;
    for (const std::uint32_t s : program_.switch_structure().members[came.unit])
      turned.push_back(workspace_.discrete_state(program_.switches()[s].discrete_state));
    const bool lowered = level_rest_.take(came.unit, {}, fastest_of(derivatives_, 0), t, x);
    if (lowered) {
      add(came.unit, std::move(turned), t, x);
      event_functions_.keep_at_level(came.unit);
    }
    event_functions_.evaluate(t, x, announced_);
    if (lowered) return true;
  }
  return false;
}

bool RestingComparisons::follow(double t, std::span<const double> x, Sequel& sequel) {
  sequel.rates.resize(program_.n_states());
  sequel.holds.clear();
  sequel.changes.clear();
  const auto here = program_.signals(t, x.data(), signals_.data(), workspace_);
  if (!here) return false;
  for (std::size_t e = 0; e < program_.events().size(); ++e) {
    const network::Event& event = program_.events()[e];
    const bool holds = here->condition(e);
    sequel.holds.push_back(holds);
    for (std::size_t a = 0; a < event.actions.size(); ++a) {
      const std::size_t index = event.actions[a].index;
      const double before = event.actions[a].on_state ? x[index] : workspace_.discrete_state(index);
      sequel.changes.push_back(holds ? here->action_value(e, a) - before : 0);
    }
  }
  return program_.derivatives(t, x.data(), sequel.rates.data(), workspace_);
}

bool RestingComparisons::follow_both(const Resting& of, double t, std::span<const double> x) {
  const std::vector<double> before(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  const auto& members = program_.switch_structure().members[of.unit];
  std::vector<bool> placed = slide_.taken();
  for (std::size_t m = 0; m < members.size(); ++m) {
    placed[members[m]] = true;
    workspace_.set_discrete_state(program_.switches()[members[m]].discrete_state, of.turned[m]);
  }
  const bool known_turned = place_others(program_, workspace_, event_functions_.thresholds(), placed, t, x,
                                         event_functions_turned_) &&
                            follow(t, x, turned_);
  workspace_.load_discrete_states(before);
  return follow(t, x, here_) && known_turned;  // last, so that loops keep the solution that they have here
}

bool RestingComparisons::rates_differ() const {
  return !std::equal(here_.rates.begin(), here_.rates.end(), turned_.rates.begin(),
                     [](double a, double b) { return !differ(a, b); });
}

/// Whether an event comes now that would not with the switches turned, or the other way round: one that came
/// before, as its condition then held, does not come again.
bool RestingComparisons::comes_otherwise(const Resting& of) const {
  std::size_t action = 0;
  for (std::size_t e = 0; e < here_.holds.size(); ++e) {
    const bool comes = here_.holds[e] && !of.held[e], comes_turned = turned_.holds[e] && !of.held_turned[e];
    for (std::size_t a = 0; a < program_.events()[e].actions.size(); ++a, ++action) {
      if (differ(comes ? here_.changes[action] : 0, comes_turned ? turned_.changes[action] : 0)) return true;
    }
  }
  return false;
}

/// A unit has come to rest at (t, x) by its own turn, which put its switches into the positions `turned`, in
/// the order of the unit.
void RestingComparisons::add(std::uint32_t unit, std::vector<double> turned, double t,
                             std::span<const double> x) {
  remove(unit);
  Resting resting{unit, t, std::move(turned), {}, {}};
  if (!follow_both(resting, t, x)) return;
  if (rates_differ()) return log_.warn_of_rest(unit, t, t);
  resting.held = here_.holds;
  resting.held_turned = turned_.holds;
  resting_.push_back(std::move(resting));
}

void RestingComparisons::remove(std::uint32_t unit) {
  std::erase_if(resting_, [&](const Resting& resting) { return resting.unit == unit; });
}

void RestingComparisons::look(double t, std::span<const double> x) {
  if (resting_.empty()) return;
  std::erase_if(resting_, [&](const Resting& resting) {
    const std::uint32_t s = program_.switch_structure().members[resting.unit].front();
    return std::abs(event_functions_[s]) > SlidingMode::drift() || !stands_still(resting.unit);
  });
  for (Resting& resting : resting_) {
    if (!follow_both(resting, t, x)) continue;
    if (rates_differ() || comes_otherwise(resting)) log_.warn_of_rest(resting.unit, resting.since, t);
    resting.held = here_.holds;
    resting.held_turned = turned_.holds;
  }
  event_functions_.evaluate(t, x, announced_);
}

bool RestingComparisons::contains(std::uint32_t unit) const {
  return std::any_of(resting_.begin(), resting_.end(),
                     [&](const Resting& resting) { return resting.unit == unit; });
}

}  // namespace oblique::solve
