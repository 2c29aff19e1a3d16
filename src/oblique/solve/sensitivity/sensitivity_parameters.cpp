// SPDX-License-Identifier: MIT
#include <oblique/solve/sensitivity/sensitivity_parameters.h>

#include <cmath>

#include <fmt/format.h>

#include <oblique/network/assembly/parameter_numbers.h>

namespace oblique::solve {
namespace {

[[noreturn]] void refuse_name(const diagram::FlatDiagram& diagram, const std::string& name) {
  std::vector<std::string> candidates;
  for (const diagram::FlatBlock& block : diagram.blocks) {
    for (const auto& known : block.definition->parameters)
      candidates.push_back(block.path + "." + known.name);
  }
  throw text::ReadError(text::Diagnostic{
      {diagram.file, {}},
      fmt::format("there is no sensitivity to '{}': no block has such a parameter", name),
      "BLOCK.PARAMETER of a block that is no composite, or BLOCK.INPUT[NUMBER] for the weight of a wire",
      text::suggest(name, candidates)});
}

}  // namespace

std::vector<SensitivityParameter> sensitivity_parameters(const diagram::FlatDiagram& diagram,
                                                         const std::vector<std::string>& names) {
  const network::ParameterNumbers numbers(diagram);
  std::vector<SensitivityParameter> found;
  for (const std::string& name : names) {
    const auto parameter = network::find_parameter(diagram, numbers, name);
    if (!parameter) refuse_name(diagram, name);
    if (!std::isfinite(parameter->value)) {
      throw text::ReadError(
          text::Diagnostic{{diagram.file, {}},
                           fmt::format("there is no sensitivity to '{}': it is infinite", name),
                           "a parameter that can change a little",
                           {text::Setting{"set", fmt::format("{}=1e6", name)}, " makes it finite"}});
    }
    found.push_back({name, parameter->number, parameter->value, parameter->unit});
  }
  return found;
}

}  // namespace oblique::solve
