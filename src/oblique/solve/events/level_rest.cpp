// SPDX-License-Identifier: MIT
#include <oblique/solve/events/level_rest.h>

#include <algorithm>
#include <cmath>

#include <oblique/solve/events/position_limits.h>
#include <oblique/solve/events/self_consistent.h>

namespace oblique::solve {

LevelRest::LevelRest(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
                     const Thresholds& thresholds, double span)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      thresholds_(thresholds),
      span_(span),
      probe_(program, workspace, span),
      event_functions_(program.switches().size()) {}

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
  placed_ = slide_.taken();
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
  probe_.begin(*here, fastest);
  if (!stands_still(first, probe_.rate(first))) return false;
  std::vector<std::uint32_t> switches{first};
  for (const std::uint32_t other : beside) {
    if (other != unit) switches.push_back(structure.members[other].front());
  }
  if (!probe_.look(switches, t, x)) return false;
  return std::all_of(switches.begin(), switches.end(), [&](std::uint32_t s) {
    const ProbedRate probed = probe_[s];
    if (s == first) return stands_still(s, probed.later);
    const RateScale alone{std::abs(probed.rate), std::abs(probed.later), probe_.fastest(), span_};
    const bool closed = workspace_.discrete_state(program_.switches()[s].discrete_state) == 1;
    return !leaves_rounding(probed.rate, span_) || !is_decisive(probed, alone) || (probed.rate > 0) == closed;
  });
}

}  // namespace oblique::solve
