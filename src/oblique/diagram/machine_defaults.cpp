// SPDX-License-Identifier: MIT
#include <oblique/diagram/machine_defaults.h>

#include <oblique/diagram/diagram.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::diagram::wiring {

MachineDefaults::MachineDefaults(std::string profile) : profile_(std::move(profile)) {
  if (find_machine(profile_) == nullptr) throw DiagramError(unknown_machine(profile_));
}

const std::vector<std::optional<double>>& MachineDefaults::of(const BlockDefinition& block) {
  const auto [at, is_new] = values_.try_emplace(&block, block.parameters.size());
  if (!is_new) return at->second;
  const MachineProfile& machine = *find_machine(profile_);
  for (std::size_t k = 0; k < block.parameters.size(); ++k) {
    if (block.parameters[k].saturation) at->second[k] = machine.saturation;
  }
  for (const BlockFigure& figure : machine.errors) {
    if (const auto index = figure.acts_on(block)) at->second[*index] = figure.value;
  }
  return at->second;
}

}  // namespace oblique::diagram::wiring
