// SPDX-License-Identifier: MIT
#include <oblique/diagram/overrides.h>

#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/flatten.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/diagram/terms.h>

namespace oblique::diagram::wiring {
namespace {

/// Finds one override; where its text stands in no file, the place of its findings is the setting.
class Finder {
 public:
  Finder(const ParameterOverride& override, const std::string& machine, text::Diagnostics& diagnostics)
      : override_(override),
        machine_(machine),
        place_(override.place.file.empty()
                   ? text::Place{{}, {}, {"set", fmt::format("{}={}", override.path, override.value)}}
                   : override.place),
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

  /// A block, and one of its parameters or weights.
  struct Named {
    const WiredBlock* block;
    std::string path;  ///< of the block
    std::string name;
    bool is_weight;
  };

  std::optional<Named> named(const Scope& diagram) const {
    const std::size_t bracket = override_.path.find('[');  // a signal in brackets may hold dots
    const std::size_t dot = override_.path.substr(0, bracket).rfind('.');
    if (const WiredBlock* const whole = whole_block(diagram)) {
      report_block(*whole);
      return std::nullopt;
    }
    if (dot == std::string::npos) {
      report(fmt::format("'{}' names no parameter", override_.path),
             "BLOCK.PARAMETER=VALUE or BLOCK.INPUT[NUMBER]=VALUE");
      return std::nullopt;
    }
    Named found{nullptr, override_.path.substr(0, dot), override_.path.substr(dot + 1),
                bracket != std::string::npos};
    found.block = block(diagram, found.path);
    return found.block == nullptr ? std::nullopt : std::optional(std::move(found));
  }

  /// A parameter that is a number, by its place in the definition.
  std::optional<std::size_t> parameter_index(const BlockDefinition& definition, std::string_view name) const {
    const auto index = definition.find_parameter(name);
    if (!index) {
      std::vector<std::string> names;
      for (const ParameterDefinition& p : definition.parameters) names.push_back(p.name);
      const bool input = definition.find_input(name).has_value();
      report(fmt::format("'{}' of block type '{}' is {}", name, definition.name,
                         input ? "an input" : "not a parameter"),
             {},
             input ? fmt::format("only parameters can be set, and weights of inputs: '{}[1]' is that of the "
                                 "first wire",
                                 override_.path)
                   : text::suggest(name, names));
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
    return index;
  }

  std::optional<ReplacedParameter> parameter(const BlockDefinition& definition, std::string_view name) const {
    const auto index = parameter_index(definition, name);
    if (!index) return std::nullopt;
    const ParameterDefinition& parameter = definition.parameters[*index];
    try {
      const double value = text::parse_quantity(override_.value, unit_on(machine_, parameter.unit));
      check_range(parameter, value, "the value", place_, {}, diagnostics_);
      return ReplacedParameter{*index, value};
    } catch (const text::ExpressionError& error) {
      report(error.what, error.expected, error.remedy);
      return std::nullopt;
    }
  }

  struct Wire {
    std::size_t input, index;
    const Term* term;
  };

  /// The wire that a name such as "in[2]" or "in[crank.cos]" means.
  std::optional<Wire> wire(const WiredBlock& block, std::string_view path, std::string_view name) const {
    const std::size_t bracket = name.find('[');
    const std::string_view port = name.substr(0, bracket);
    std::string_view which = name.substr(bracket + 1);
    if (!which.ends_with(']') || which.size() == 1) {
      report(fmt::format("'{}' names no wire", override_.path),
             fmt::format("a number or a signal in brackets, such as '{}.{}[1]'", path, port));
      return std::nullopt;
    }
    which.remove_suffix(1);
    const std::vector<Wire> wires = wires_at(block, port);
    if (wires.empty()) {
      report_no_wires(block, path, port);
      return std::nullopt;
    }
    return find_wire(wires, which, fmt::format("{}.{}", path, port));
  }

  std::optional<ReplacedWeight> weight(const WiredBlock& block, std::string_view path,
                                       std::string_view name) const {
    const auto found = wire(block, path, name);
    if (!found) return std::nullopt;
    try {
      const double value = text::parse_quantity(override_.value, text::Unit{});
      if (std::isfinite(value)) return ReplacedWeight{found->input, found->index, value};
      report(fmt::format("the weight is {}", describe_number(value)), "a finite number");
    } catch (const text::ExpressionError& error) {
      report(error.what, error.expected, error.remedy);
    }
    return std::nullopt;
  }

  void report(std::string what, std::string expected = {}, std::string remedy = {}) const {
    diagnostics_.add({place_, std::move(what), std::move(expected), std::move(remedy)});
  }

 private:
  /// The wires of an input in their order; where a block has several inputs and none is called "in", those of
  /// its list `in`, one to an input.
  static std::vector<Wire> wires_at(const WiredBlock& block, std::string_view port) {
    const auto own = block.definition->find_input(port);
    std::vector<Wire> wires;
    for (std::size_t input = 0; input < block.inputs.size(); ++input) {
      if (own ? input != *own : port != "in") continue;
      for (std::size_t k = 0; k < block.inputs[input].terms.size(); ++k)
        wires.push_back({input, k, &block.inputs[input].terms[k]});
    }
    return wires;
  }

  /// The block that the whole path names, where it names one and no parameter.
  const WiredBlock* whole_block(const Scope& diagram) const {
    const Scope* scope = &diagram;
    const BlockDefinition* around = nullptr;
    for (std::size_t at = 0; scope != nullptr;) {
      const std::size_t end = std::min(override_.path.find('.', at), override_.path.size());
      const std::string_view name = std::string_view(override_.path).substr(at, end - at);
      const auto index = scope->index.find(name);
      if (index == scope->index.end() || (around != nullptr && around->find_parameter(name))) return nullptr;
      const WiredBlock& block = scope->blocks[index->second];
      if (block.definition == nullptr) return nullptr;
      if (end == override_.path.size()) return &block;
      around = block.definition;
      scope = block.inside;
      at = end + 1;
    }
    return nullptr;
  }

  void report_block(const WiredBlock& block) const {
    std::vector<std::string> names;
    for (const ParameterDefinition& parameter : block.definition->parameters) {
      if (!parameter.points && !parameter.formula)
        names.push_back(fmt::format("{}.{}", override_.path, parameter.name));
    }
    for (std::size_t k = 0; k < block.inputs.size(); ++k) {
      if (!block.inputs[k].terms.empty())
        names.push_back(weight_name(override_.path, block.definition->inputs[k].name, 0));
    }
    report(fmt::format("'{}' is a block, not one of its values", override_.path),
           names.empty()       ? "a block that has any"
           : names.size() == 1 ? names.front()
                               : fmt::format("one of {}", fmt::join(names, ", ")));
  }

  void report_no_wires(const WiredBlock& block, std::string_view path, std::string_view port) const {
    const BlockDefinition& definition = *block.definition;
    if (definition.find_input(port)) {
      report(fmt::format("nothing is wired to input '{}.{}'", path, port), "an input with a wire");
      return;
    }
    std::vector<std::string> names;
    for (const InputPort& input : definition.inputs) names.push_back(input.name);
    const bool parameter = definition.find_parameter(port).has_value();
    report(fmt::format("'{}' of block type '{}' is {}", port, definition.name,
                       parameter ? "a parameter, which has no weights" : "not an input"),
           {}, parameter ? fmt::format("'{}.{}' sets it", path, port) : text::suggest(port, names));
  }

  /// The wire that a number from 1 or the name of a signal picks.
  std::optional<Wire> find_wire(const std::vector<Wire>& wires, std::string_view which,
                                const std::string& input) const {
    if (which.find_first_not_of("0123456789") == std::string_view::npos) {
      std::size_t number = 0;
      const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), number);
      if (error == std::errc() && number >= 1 && number <= wires.size()) return wires[number - 1];
      report(fmt::format("input '{}' has no wire {}", input, which),
             wires.size() == 1 ? "1" : fmt::format("a number from 1 to {}", wires.size()));
      return std::nullopt;
    }
    std::vector<Wire> found;
    std::vector<std::string> signals, places;
    for (std::size_t k = 0; k < wires.size(); ++k) {
      signals.push_back(wires[k].term->signal);
      if (signals.back() != which) continue;
      found.push_back(wires[k]);
      places.push_back(fmt::format("[{}]", k + 1));
    }
    if (found.size() == 1) return found.front();
    if (found.empty()) {
      report(fmt::format("no wire of input '{}' comes from '{}'", input, which), {},
             text::suggest(which, signals));
    } else {
      report(fmt::format("{} wires of input '{}' come from '{}'", found.size(), input, which),
             fmt::format("one of {}", fmt::join(places, ", ")));
    }
    return std::nullopt;
  }

  const ParameterOverride& override_;
  const std::string& machine_;
  text::Place place_;
  text::Diagnostics& diagnostics_;
};

}  // namespace

std::string weight_name(std::string_view block, std::string_view input, std::size_t wire) {
  return fmt::format("{}.{}[{}]", block, input, wire + 1);
}

Replacements resolve_overrides(const Scope& diagram, const std::vector<ParameterOverride>& overrides,
                               text::Diagnostics& diagnostics) {
  Replacements replacements;
  for (const ParameterOverride& override : overrides) {
    const Finder finder(override, diagram.machine, diagnostics);
    const auto named = finder.named(diagram);
    if (!named) continue;
    if (named->is_weight) {
      if (const auto weight = finder.weight(*named->block, named->path, named->name))
        replacements[named->path].weights.push_back(*weight);
    } else if (const auto parameter = finder.parameter(*named->block->definition, named->name)) {
      replacements[named->path].parameters.push_back(*parameter);
    }
  }
  return replacements;
}

void check_override_path(const Scope& diagram, const std::string& path, const text::Place& place,
                         text::Diagnostics& diagnostics) {
  const ParameterOverride override{path, {}, place};
  const Finder finder(override, diagram.machine, diagnostics);
  const auto named = finder.named(diagram);
  if (!named) return;
  if (named->is_weight) {
    finder.wire(*named->block, named->path, named->name);
  } else {
    finder.parameter_index(*named->block->definition, named->name);
  }
}

}  // namespace oblique::diagram::wiring
