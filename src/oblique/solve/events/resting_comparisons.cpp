// SPDX-License-Identifier: MIT
#include <oblique/solve/events/resting_comparisons.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <oblique/solve/events/self_consistent.h>

namespace oblique::solve {
namespace {

/// Whether two values differ by more than rounding and the errors of the states make of them.
bool differ(double a, double b) {
  constexpr double kMuch = 1e-6;  // of 1 + the value
  return std::abs(a - b) > kMuch * (1 + std::abs(a));
}

}  // namespace

RestingComparisons::RestingComparisons(const network::Program& program, network::Workspace& workspace,
                                       const Thresholds& thresholds, EventLog& log)
    : program_(program),
      workspace_(workspace),
      thresholds_(thresholds),
      log_(log),
      signals_(program.n_signals()),
      event_functions_(program.switches().size()) {}

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
  std::vector<bool> placed(event_functions_.size(), false);
  for (std::size_t m = 0; m < members.size(); ++m) {
    placed[members[m]] = true;
    workspace_.set_discrete_state(program_.switches()[members[m]].discrete_state, of.turned[m]);
  }
  const bool known_turned = place_others(program_, workspace_, thresholds_, placed, t, x, event_functions_) &&
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
  for (Resting& resting : resting_) {
    if (!follow_both(resting, t, x)) continue;
    if (rates_differ() || comes_otherwise(resting)) log_.warn_of_rest(resting.unit, resting.since, t);
    resting.held = here_.holds;
    resting.held_turned = turned_.holds;
  }
}

std::vector<std::uint32_t> RestingComparisons::units() const {
  std::vector<std::uint32_t> units;
  for (const Resting& resting : resting_) units.push_back(resting.unit);
  return units;
}

}  // namespace oblique::solve
