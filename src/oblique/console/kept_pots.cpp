// SPDX-License-Identifier: MIT
#include <oblique/console/kept_pots.h>

#include <algorithm>
#include <string>

namespace oblique::console {
namespace {

/// Whether two files say the same of a parameter of a block; of a weight or of what is inside, of the
/// whole.
bool says_the_same(const diagram::BlockInstance& before, const diagram::BlockInstance& now,
                   const std::string& pot) {
  const auto said = [&](const diagram::BlockInstance& block) {
    diagram::BlockInstance part;
    const bool is_parameter = pot.find_first_of(".[") == std::string::npos;
    for (const text::Entry& setting : block.settings) {
      if (!is_parameter || setting.key == pot) part.settings.push_back(setting);
    }
    return part;
  };
  return said(before) == said(now);
}

}  // namespace

std::vector<diagram::ParameterOverride> kept_pots(const Pots& pots, const diagram::Diagram& next,
                                                  const Renamed& renamed) {
  std::vector<diagram::ParameterOverride> kept;
  for (const diagram::BlockInstance& now : next.blocks) {
    const std::string name = path_before(now.name, renamed);
    const auto& blocks = pots.diagram().blocks;
    const auto before = std::find_if(blocks.begin(), blocks.end(), [&](const diagram::BlockInstance& block) {
      return block.name == name && block.type == now.type;
    });
    if (before == blocks.end()) continue;
    for (const diagram::ParameterOverride& turned : pots.turned()) {
      if (!turned.path.starts_with(name + ".")) continue;
      const std::string pot = turned.path.substr(name.size() + 1);
      if (says_the_same(*before, now, pot)) kept.push_back({now.name + "." + pot, turned.value});
    }
  }
  return kept;
}

}  // namespace oblique::console
