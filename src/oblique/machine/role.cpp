// SPDX-License-Identifier: MIT
#include <oblique/machine/role.h>

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace oblique::machine {

Role role_of(std::string_view block) {
  constexpr std::array<std::pair<std::string_view, Role>, 9> kRoles{
      {{"constant", Role::reference},
       {"potentiometer", Role::coefficient},
       {"gain", Role::coefficient},
       {"inverter", Role::inverter},
       {"summer", Role::summer},
       {"integrator", Role::integrator},
       {"servo-amplifier", Role::open_amplifier},
       {"multiplier", Role::multiplier},
       {"squarer", Role::multiplier}}};
  const auto* const found =
      std::find_if(kRoles.begin(), kRoles.end(), [&](const auto& entry) { return entry.first == block; });
  return found == kRoles.end() ? Role::other : found->second;
}

Role role_of(const diagram::BlockDefinition& definition) {
  const Role role = role_of(definition.name);
  const auto has = [&](std::initializer_list<std::string_view> names) {
    return std::all_of(names.begin(), names.end(),
                       [&](std::string_view name) { return definition.find_parameter(name).has_value(); });
  };
  switch (role) {
    case Role::reference:
      return has({"value"}) ? role : Role::other;
    case Role::coefficient:
      return has({definition.name == "gain" ? "factor" : "setting"}) ? role : Role::other;
    case Role::integrator:
      return has({"rate", "initial"}) ? role : Role::other;
    default:
      return role;
  }
}

bool has_defaults(const diagram::FlatBlock& block, std::initializer_list<std::string_view> but) {
  const auto& parameters = block.definition->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (std::find(but.begin(), but.end(), parameters[k].name) != but.end()) continue;
    if (block.parameters[k] != parameters[k].default_value) return false;
  }
  return true;
}

double parameter_of(const diagram::FlatBlock& block, std::string_view name) {
  return block.parameters[block.definition->find_parameter(name).value()];
}

std::string ElementNumbers::next(std::string_view block) {
  const auto letter = [&] {
    switch (role_of(block)) {
      case Role::coefficient:
        return 'P';
      case Role::multiplier:
        return 'M';
      case Role::other:
        return block == "comparator" ? 'K' : block == "function-generator" ? 'F' : 'X';
      default:
        return 'A';
    }
  };
  if (role_of(block) == Role::reference) return {};
  const char kind = letter();
  return fmt::format("{}{}", kind, ++last_[kind]);
}

}  // namespace oblique::machine
