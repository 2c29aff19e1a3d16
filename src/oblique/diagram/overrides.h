// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/scope.h>

namespace oblique::diagram::wiring {

/// A parameter, by its place in the definition, and the value it gets.
struct ReplacedParameter {
  std::size_t parameter = 0;
  double value = 0;
};

/// Replaced parameters by the path of their block.
using Replacements = std::unordered_map<std::string, std::vector<ReplacedParameter>>;

/// Finds the blocks and parameters that overrides name; reports those there are not, and wrong values.
Replacements resolve_overrides(const Scope& diagram, const std::vector<ParameterOverride>& overrides,
                               text::Diagnostics& diagnostics);

}  // namespace oblique::diagram::wiring
