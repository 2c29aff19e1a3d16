// SPDX-License-Identifier: MIT
#include <oblique/machine/coarse_settings.h>

#include <cmath>

#include <oblique/machine/role.h>

namespace oblique::machine {
namespace {

constexpr double kFewSteps = 10;  ///< half a step is then 5 % of the setting

}  // namespace

std::vector<CoarseSetting> coarse_settings(const diagram::FlatDiagram& diagram,
                                           const diagram::MachineProfile& machine) {
  std::vector<CoarseSetting> coarse;
  if (machine.name == "ideal") return coarse;
  const std::vector<std::string> numbers = element_numbers(diagram);
  for (std::size_t b = 0; b < diagram.blocks.size(); ++b) {
    const diagram::FlatBlock& block = diagram.blocks[b];
    if (block.definition->role != Role::potentiometer) continue;
    const double setting = parameter_of(block, "setting");
    const bool is_published =
        block.definition->find_parameter("turns") && std::isfinite(parameter_of(block, "turns"));
    const double step = is_published ? 1 / parameter_of(block, "turns") : kSheetStep;
    const double least = kFewSteps * step, size = std::abs(setting);
    if (size == 0 || !(size < least)) continue;
    const int in_series = static_cast<int>(std::ceil(std::log(size) / std::log(least)));
    coarse.push_back({numbers[b], block.path, setting, step, is_published, in_series});
  }
  return coarse;
}

}  // namespace oblique::machine
