// SPDX-License-Identifier: MIT
#include <oblique/machine/role.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <oblique/machine/realise.h>

namespace oblique::machine {

bool is_coefficient(Role role) {
  return role == Role::potentiometer || role == Role::gain;
}

bool is_product(Role role) {
  return role == Role::multiplier || role == Role::squarer;
}

bool stays_as_it_is(Role role) {
  return role == Role::comparator || role == Role::function_generator || role == Role::other;
}

const diagram::BlockDefinition& element_block(const diagram::BlockLibrary& library, Role role) {
  const diagram::BlockDefinition* const block = library.find(role);
  if (block != nullptr) return *block;
  const std::string_view name = diagram::role_name(role);
  throw RealiseError(text::Diagnostic{
      {},
      fmt::format("no block has the role '{}', which the machine's elements are written with", name),
      fmt::format("role = \"{}\" in a block file", name),
      "a block in the place of a shipped one takes its role too"});
}

diagram::FlatBlock element(const diagram::BlockLibrary& library, Role role, std::string path,
                           const text::Place& place) {
  diagram::FlatBlock made;
  made.definition = &element_block(library, role);
  made.path = std::move(path);
  made.place = place;
  for (const diagram::ParameterDefinition& parameter : made.definition->parameters)
    made.parameters.push_back(parameter.default_value);
  made.choose_behaviour();
  for (const diagram::InputPort& input : made.definition->inputs)
    made.inputs.push_back({{}, input.default_value.value_or(0)});
  return made;
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

std::string ElementNumbers::next(Role role) {
  const auto letter = [&] {
    if (is_coefficient(role)) return 'P';
    if (is_product(role)) return 'M';
    switch (role) {
      case Role::comparator:
        return 'K';
      case Role::function_generator:
        return 'F';
      case Role::other:
        return 'X';
      default:
        return 'A';
    }
  };
  if (role == Role::reference) return {};
  const char kind = letter();
  return fmt::format("{}{}", kind, ++last_[kind]);
}

std::vector<std::string> element_numbers(const diagram::FlatDiagram& diagram) {
  ElementNumbers numbers;
  std::vector<std::string> all;
  for (const diagram::FlatBlock& block : diagram.blocks) {
    const bool reference = block.definition->role == Role::reference;
    all.push_back(reference ? (parameter_of(block, "value") < 0 ? "−REF" : "+REF")
                            : numbers.next(block.definition->role));
  }
  return all;
}

}  // namespace oblique::machine
