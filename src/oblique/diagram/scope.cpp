// SPDX-License-Identifier: MIT
#include <oblique/diagram/scope.h>

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace oblique::diagram::wiring {
namespace {

/// The first part of a dotted path, which is cut off its front.
std::string_view take_part(std::string_view& path) {
  const std::size_t dot = path.find('.');
  const std::string_view part = path.substr(0, dot);
  path = dot == std::string_view::npos ? std::string_view() : path.substr(dot + 1);
  return part;
}

std::vector<std::string> names_inside(const WiredBlock& block) {
  std::vector<std::string> names;
  for (const OutputPort& output : block.definition->outputs) names.push_back(output.name);
  if (block.inside == nullptr) return names;
  for (const WiredBlock& inner : block.inside->blocks) names.push_back(inner.instance->name);
  return names;
}

/// Messages beyond this number do without a search for the nearest name, which looks at every block.
constexpr std::size_t kMostSuggestions = 100;

}  // namespace

double Constant::value(const BlockDefinition* composite, std::span<const double> parameters) const {
  if (!expression) return number;
  const auto lookup = [&](std::string_view name) -> std::optional<double> {
    const auto index = composite->find_parameter(name);
    return index ? std::optional(parameters[*index]) : std::nullopt;
  };
  return number * text::evaluate(*expression, lookup);
}

std::string Scope::belonging() const {
  return composite == nullptr ? "" : fmt::format(" of composite '{}'", composite->name);
}

std::vector<std::string> Scope::signal_names() const {
  std::vector<std::string> names;
  if (composite != nullptr) {
    for (const InputPort& input : composite->inputs) names.push_back(input.name);
  }
  for (const WiredBlock& block : blocks) names.push_back(block.instance->name);
  return names;
}

std::string describe_port(const Scope& scope, std::string_view kind, const WiredBlock& block,
                          std::string_view port) {
  return fmt::format("{} '{}.{}'{}", kind, block.instance->name, port, scope.belonging());
}

std::string describe_block(const Scope& scope, const WiredBlock& block) {
  return fmt::format("block '{}' ({}){}", block.instance->name, block.instance->type, scope.belonging());
}

std::string describe_number(double number) {
  return std::isnan(number) ? "not a number" : fmt::format("{}", number);
}

std::optional<Source> find_signal(const Scope& scope, std::string_view path, text::SourcePosition position,
                                  const std::string& subject, text::Diagnostics& diagnostics) {
  const auto report = [&](std::string what, std::string expected, std::string remedy) {
    diagnostics.add({{scope.file, position},
                     fmt::format("{}: {}", subject, what),
                     std::move(expected),
                     std::move(remedy)});
    return std::nullopt;
  };
  std::string_view rest = path;
  const std::string_view first = take_part(rest);
  if (scope.composite != nullptr) {
    if (const auto input = scope.composite->find_input(first)) {
      if (rest.empty()) return Source{input, {}, 0};
      return report(fmt::format("'{}' is an input of the composite, so there is no '{}'", first, path),
                    fmt::format("'{}' alone", first), {});
    }
  }
  const auto found = scope.index.find(first);
  if (found == scope.index.end()) {
    std::string remedy;
    if (diagnostics.size() < kMostSuggestions) remedy = text::suggest(first, scope.signal_names());
    return report(fmt::format("there is no signal '{}'", path), {}, std::move(remedy));
  }
  Source source;
  source.blocks.push_back(found->second);
  const WiredBlock* block = &scope.blocks[found->second];
  while (true) {
    if (block->definition == nullptr) return std::nullopt;  // reported with the block
    const std::string_view block_path = path.substr(0, path.size() - rest.size() - (rest.empty() ? 0 : 1));
    const std::vector<OutputPort>& outputs = block->definition->outputs;
    if (rest.empty()) {
      if (outputs.size() == 1) return source;
      std::vector<std::string> ports;
      ports.reserve(outputs.size());
      for (const OutputPort& output : outputs) ports.push_back(fmt::format("{}.{}", path, output.name));
      return report(fmt::format("'{}' has {} outputs", path, outputs.size()),
                    fmt::format("one of {}", fmt::join(ports, ", ")), {});
    }
    if (const auto output = block->definition->find_output(rest)) {
      source.output = *output;
      return source;
    }
    const std::string_view part = take_part(rest);
    if (block->inside != nullptr) {
      if (const auto inner = block->inside->index.find(part); inner != block->inside->index.end()) {
        source.blocks.push_back(inner->second);
        block = &block->inside->blocks[inner->second];
        continue;
      }
    }
    if (block->definition->find_output(part)) {
      return report(fmt::format("'{}.{}' is a signal, so there is no '{}'", block_path, part, path),
                    fmt::format("'{}.{}'", block_path, part), {});
    }
    return report(fmt::format("'{}' ({}) has no output{} '{}'", block_path, block->instance->type,
                              block->inside == nullptr ? "" : " and no inner block", part),
                  {}, text::suggest(part, names_inside(*block)));
  }
}

}  // namespace oblique::diagram::wiring
