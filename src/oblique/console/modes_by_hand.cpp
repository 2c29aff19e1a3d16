// SPDX-License-Identifier: MIT
#include <oblique/console/modes_by_hand.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace oblique::console {
namespace {

diagram::Phase whole_phase(diagram::OperatingMode mode) {
  diagram::Phase phase;
  phase.mode = mode;
  phase.duration = std::numeric_limits<double>::infinity();
  return phase;
}

constexpr diagram::OperatingMode kModes[] = {diagram::OperatingMode::operate, diagram::OperatingMode::initial,
                                             diagram::OperatingMode::hold, diagram::OperatingMode::potset};

}  // namespace

diagram::Timeline modes_by_hand() {
  diagram::Timeline timeline;
  for (const diagram::OperatingMode each : kModes) timeline.phases.push_back(whole_phase(each));
  return timeline;
}

solve::PhasePosition position_in(diagram::OperatingMode mode) {
  solve::PhasePosition position;
  position.phase =
      static_cast<std::size_t>(std::find(std::begin(kModes), std::end(kModes), mode) - std::begin(kModes));
  return position;
}

diagram::Timeline repetition(double initial, double operate) {
  diagram::Timeline timeline;
  timeline.phases = {whole_phase(diagram::OperatingMode::initial),
                     whole_phase(diagram::OperatingMode::operate)};
  timeline.phases[0].duration = initial;
  timeline.phases[1].duration = operate;
  timeline.cycles = std::numeric_limits<double>::infinity();
  return timeline;
}

void take_modes_of(solve::RunState& state, Pots& pots) {
  const auto known = std::find_if(state.memories.begin(), state.memories.end(), [](const auto& memory) {
    return memory.first.starts_with("mode of group ");
  });
  const std::vector<diagram::Phase>& phases = pots.diagram().timeline.phases;
  if (known == state.memories.end()) {
    if (!phases.empty()) pots.set_timeline({});
    return;
  }
  const auto mode = static_cast<diagram::OperatingMode>(static_cast<int>(known->second));
  if (state.position.phase < phases.size() && phases[state.position.phase].mode == mode) return;
  pots.set_timeline(modes_by_hand());
  state.position = position_in(mode);
}

}  // namespace oblique::console
