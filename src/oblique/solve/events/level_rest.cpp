// SPDX-License-Identifier: MIT
#include <oblique/solve/events/level_rest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/solve/events/position_limits.h>
#include <oblique/solve/events/self_consistent.h>

namespace oblique::solve {

LevelRest::LevelRest(const network::Program& program, network::Workspace& workspace,
                     const Thresholds& thresholds, double span)
    : program_(program),
      workspace_(workspace),
      thresholds_(thresholds),
      span_(span),
      event_functions_(program.switches().size()),
      rates_(program.switches().size()),
      derivatives_(program.n_states()),
      moved_(program.n_states()) {}

bool LevelRest::is_third_position(std::uint32_t unit) const {
  const network::SwitchStructure& structure = program_.switch_structure();
  bool along = false, against = false;
  for (const std::uint32_t s : structure.members[unit]) {
    if (program_.switches()[s].turning != network::Turning::jumps || program_.switches()[s].rate) continue;
    along = along || !structure.opposite[s];
    against = against || structure.opposite[s];
  }
  return along && against;
}

bool LevelRest::stands_still(std::uint32_t s, double rate) const {
  return std::abs(rate) * span_ <= thresholds_.rounding(s);
}

bool LevelRest::take(std::uint32_t unit, const std::vector<std::uint32_t>& beside, double fastest, double t,
                     std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  const std::vector<double> before(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  if (!program_.event_functions(t, x.data(), event_functions_.data(), workspace_)) return false;
  const double event_function = event_functions_[structure.members[unit].front()];
  placed_.assign(event_functions_.size(), false);
  for (const std::uint32_t other : beside) {
    for (const std::uint32_t s : structure.members[other]) placed_[s] = true;
  }
  for (const std::uint32_t s : structure.members[unit]) {
    placed_[s] = true;
    workspace_.set_discrete_state(program_.switches()[s].discrete_state, 0);
  }
  if (stays(unit, beside, event_function, fastest, t, x)) return true;
  workspace_.load_discrete_states(before);
  return false;
}

bool LevelRest::stays(std::uint32_t unit, const std::vector<std::uint32_t>& beside, double event_function,
                      double fastest, double t, std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  const std::uint32_t first = structure.members[unit].front();
  const auto here = place_others(program_, workspace_, thresholds_, placed_, t, x, event_functions_);
  if (!here || event_functions_[first] != event_function) return false;
  here->derivatives(derivatives_.data());
  here->event_function_rates(derivatives_.data(), rates_.data());
  fastest = fastest_of(derivatives_, std::max(fastest, std::numeric_limits<double>::min()));
  if (!stands_still(first, rates_[first])) return false;
  for (const std::uint32_t other : beside) {
    const std::uint32_t s = structure.members[other].front();
    const bool closed = workspace_.discrete_state(program_.switches()[s].discrete_state) == 1;
    const bool moves = std::abs(rates_[s]) > kRounding * fastest && leaves_rounding(rates_[s], span_);
    if (other != unit && moves && (rates_[s] > 0) != closed) return false;
  }
  const double step = std::min(kProbe / fastest, kProbe * span_);
  for (std::size_t i = 0; i < x.size(); ++i) moved_[i] = x[i] + step * derivatives_[i];
  const auto later = program_.event_functions(t + step, moved_.data(), event_functions_.data(), workspace_);
  if (!later) return false;
  later->derivatives(derivatives_.data());
  later->event_function_rates(derivatives_.data(), rates_.data());
  return stands_still(first, rates_[first]);
}

}  // namespace oblique::solve
