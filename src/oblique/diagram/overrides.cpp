// SPDX-License-Identifier: MIT
#include <oblique/diagram/overrides.h>

#include <fmt/format.h>

#include <oblique/diagram/machine_profile.h>

namespace oblique::diagram::wiring {
namespace {

/// Finds one override; the place of its findings is the setting, since its text stands in no file.
class Finder {
 public:
  Finder(const ParameterOverride& override, const std::string& machine, text::Diagnostics& diagnostics)
      : override_(override),
        machine_(machine),
        place_{{}, {}, {"set", fmt::format("{}={}", override.path, override.value)}},
        diagnostics_(diagnostics) {}

  /// The block that a path names; nothing where there is none, or where it is broken and reported with its
  /// file.
  const WiredBlock* block(const Scope& diagram, std::string_view path) const {
    const Scope* scope = &diagram;
    const WiredBlock* found = nullptr;
    for (std::size_t at = 0; at <= path.size();) {
      const std::size_t end = std::min(path.find('.', at), path.size());
      const std::string_view name = path.substr(at, end - at);
      if (scope == nullptr) {
        report(fmt::format("'{}' ({}) has no inner blocks", path.substr(0, at - 1), found->instance->type));
        return nullptr;
      }
      const auto index = scope->index.find(name);
      if (index == scope->index.end()) {
        std::vector<std::string> names;
        for (const WiredBlock& block : scope->blocks) names.push_back(block.instance->name);
        report(fmt::format("there is no block '{}'", path.substr(0, end)), {}, text::suggest(name, names));
        return nullptr;
      }
      found = &scope->blocks[index->second];
      if (found->definition == nullptr) return nullptr;
      scope = found->inside;
      at = end + 1;
    }
    return found;
  }

  std::optional<ReplacedParameter> parameter(const BlockDefinition& definition, std::string_view name) const {
    const auto index = definition.find_parameter(name);
    if (!index) {
      std::vector<std::string> names;
      for (const ParameterDefinition& p : definition.parameters) names.push_back(p.name);
      const bool input = definition.find_input(name).has_value();
      report(fmt::format("'{}' of block type '{}' is {}", name, definition.name,
                         input ? "an input" : "not a parameter"),
             {}, input ? "only parameters can be set" : text::suggest(name, names));
      return std::nullopt;
    }
    const ParameterDefinition& parameter = definition.parameters[*index];
    if (parameter.points) {
      report(fmt::format("'{}' is a function given by points", name), "a parameter that is a number",
             "change the points in the diagram");
      return std::nullopt;
    }
    if (parameter.formula) {
      report(fmt::format("'{}' is a formula", name), "a parameter that is a number",
             "change the formula in the diagram");
      return std::nullopt;
    }
    try {
      const double value = text::parse_quantity(override_.value, unit_on(machine_, parameter.unit));
      check_range(parameter, value, "the value", place_, {}, diagnostics_);
      return ReplacedParameter{*index, value};
    } catch (const text::ExpressionError& error) {
      report(error.what, error.expected, error.remedy);
      return std::nullopt;
    }
  }

  void report(std::string what, std::string expected = {}, std::string remedy = {}) const {
    diagnostics_.add({place_, std::move(what), std::move(expected), std::move(remedy)});
  }

 private:
  const ParameterOverride& override_;
  const std::string& machine_;
  text::Place place_;
  text::Diagnostics& diagnostics_;
};

}  // namespace

Replacements resolve_overrides(const Scope& diagram, const std::vector<ParameterOverride>& overrides,
                               text::Diagnostics& diagnostics) {
  Replacements replacements;
  for (const ParameterOverride& override : overrides) {
    const Finder finder(override, diagram.machine, diagnostics);
    const std::size_t dot = override.path.rfind('.');
    if (dot == std::string::npos) {
      finder.report(fmt::format("'{}' names no parameter", override.path), "BLOCK.PARAMETER=VALUE");
      continue;
    }
    const std::string path = override.path.substr(0, dot);
    const WiredBlock* const block = finder.block(diagram, path);
    if (block == nullptr) continue;
    const auto replaced =
        finder.parameter(*block->definition, std::string_view(override.path).substr(dot + 1));
    if (replaced) replacements[path].push_back(*replaced);
  }
  return replacements;
}

}  // namespace oblique::diagram::wiring
