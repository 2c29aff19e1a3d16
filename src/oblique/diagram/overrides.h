// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include <oblique/diagram/flatten.h>
#include <oblique/diagram/scope.h>

namespace oblique::diagram::wiring {

/// A parameter, by its place in the definition, and the value it gets.
struct ReplacedParameter {
  std::size_t parameter = 0;
  double value = 0;
};

/// A weight, by the places of its input in the definition and of its wire at the input, and the value it
/// gets.
struct ReplacedWeight {
  std::size_t input = 0;
  std::size_t wire = 0;
  double value = 0;
};

/// What is replaced in one block.
struct Replacement {
  std::vector<ReplacedParameter> parameters;
  std::vector<ReplacedWeight> weights;
};

/// What is replaced, by the paths of the blocks.
using Replacements = std::unordered_map<std::string, Replacement>;

/// "c.in[2]": the weight of the second wire of an input.
std::string weight_name(std::string_view block, std::string_view input, std::size_t wire);

/// Finds the blocks, parameters and weights that overrides name; reports those there are not, and wrong
/// values.
Replacements resolve_overrides(const Scope& diagram, const std::vector<ParameterOverride>& overrides,
                               text::Diagnostics& diagnostics);

/// Reports where `path` names no parameter and no weight of the diagram.
void check_override_path(const Scope& diagram, const std::string& path, const text::Place& place,
                         text::Diagnostics& diagnostics);

}  // namespace oblique::diagram::wiring
