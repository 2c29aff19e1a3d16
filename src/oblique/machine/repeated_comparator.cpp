// SPDX-License-Identifier: MIT
#include <oblique/machine/repeated_comparator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include <oblique/machine/role.h>
#include <oblique/text/expression.h>

namespace oblique::machine {
namespace {

/// What it gives for the sum of its inputs; not a number where that hangs on what was before.
double value_at(const diagram::FlatBlock& comparator, double sum) {
  const auto& equations = comparator.behaviour->equations;
  if (equations.size() != 1) return std::nan("");
  try {
    return text::evaluate(equations.front().expression, [&](std::string_view name) -> std::optional<double> {
      if (comparator.definition->find_input(name)) return sum;
      const auto parameter = comparator.definition->find_parameter(name);
      return parameter ? std::optional(comparator.parameters[*parameter]) : std::nullopt;
    });
  } catch (const text::ExpressionError&) {
    return std::nan("");
  }
}

}  // namespace

bool only_repeats(const diagram::FlatBlock& comparator, double weight, double offset,
                  const diagram::FlatBlock& source) {
  const diagram::BlockDefinition& definition = *comparator.definition;
  constexpr std::array<std::string_view, 2> kLevels{"low", "high"};
  return source.definition == &definition &&
         std::all_of(kLevels.begin(), kLevels.end(), [&](std::string_view name) {
           const auto parameter = definition.find_parameter(name);
           if (!parameter) return false;
           const double level = source.parameters[*parameter];
           return value_at(comparator, weight * level + offset) == level;
         });
}

}  // namespace oblique::machine
