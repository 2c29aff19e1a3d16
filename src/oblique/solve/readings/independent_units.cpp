// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/independent_units.h>

#include <algorithm>
#include <utility>

namespace oblique::solve {

const network::SwitchStructure::Ancestry& IndependentUnits::ancestry(std::uint32_t unit) {
  auto& known = ancestries_[unit];
  if (!known) known = program_.switch_structure().ancestry(unit, program_.events());
  return *known;
}

bool IndependentUnits::acts(std::uint32_t unit, std::uint32_t on) {
  const auto& positions = ancestry(on).discrete_states;
  const auto& members = program_.switch_structure().members[unit];
  return std::any_of(members.begin(), members.end(),
                     [&](std::uint32_t s) { return positions[program_.switches()[s].discrete_state]; });
}

bool IndependentUnits::acts(const network::Event& event, std::uint32_t on) {
  const network::SwitchStructure::Ancestry& below = ancestry(on);
  return std::any_of(event.actions.begin(), event.actions.end(), [&](const network::Event::Action& action) {
    return action.on_state ? below.states[action.index] : below.discrete_states[action.index];
  });
}

bool IndependentUnits::are(std::uint32_t unit_a, std::uint32_t unit_b) {
  return unit_a != unit_b && !acts(unit_a, unit_b) && !acts(unit_b, unit_a);
}

std::vector<std::vector<std::size_t>> IndependentUnits::parts_of(std::span<const std::uint32_t> units) {
  std::vector<std::size_t> part_of(units.size(), 0);
  for (std::size_t u = 0; u < units.size() && units.size() <= kMostUnits; ++u) {
    part_of[u] = u;
    for (std::size_t v = 0; v < u; ++v) {
      if (part_of[v] == part_of[u] || are(units[u], units[v])) continue;
      const std::size_t first = std::min(part_of[u], part_of[v]), second = std::max(part_of[u], part_of[v]);
      std::replace(part_of.begin(), part_of.begin() + static_cast<std::ptrdiff_t>(u) + 1, second, first);
    }
  }
  std::vector<std::vector<std::size_t>> parts(units.size());
  for (std::size_t u = 0; u < units.size(); ++u) parts[part_of[u]].push_back(u);
  std::erase_if(parts, [](const auto& part) { return part.empty(); });
  return parts;
}

std::vector<std::vector<std::uint32_t>> IndependentUnits::mutual_of(std::span<const std::uint32_t> units) {
  struct Group {
    std::vector<std::uint32_t> units;
    std::ptrdiff_t acting = 0;  ///< units that act on it: fewer than on what it acts on
  };
  std::vector<Group> groups;
  for (const std::uint32_t unit : units) {
    const auto own = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return acts(group.units.front(), unit) && acts(unit, group.units.front());
    });
    if (own != groups.end()) {
      own->units.push_back(unit);
      continue;
    }
    const auto acting = std::count_if(
        units.begin(), units.end(), [&](std::uint32_t other) { return other != unit && acts(other, unit); });
    groups.push_back({{unit}, acting});
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return a.acting < b.acting; });
  std::vector<std::vector<std::uint32_t>> ordered;
  ordered.reserve(groups.size());
  for (Group& group : groups) ordered.push_back(std::move(group.units));
  return ordered;
}

}  // namespace oblique::solve
