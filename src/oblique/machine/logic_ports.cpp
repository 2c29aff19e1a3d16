// SPDX-License-Identifier: MIT
#include <oblique/machine/logic_ports.h>

#include <cmath>

#include <oblique/diagram/block_scaling.h>
#include <oblique/text/quantity.h>

namespace oblique::machine {
namespace {

/// Any factor but 1 tells what follows it.
constexpr double kFactor = 3;

/// Which of the factors are 1; nothing where one is neither that nor kFactor.
std::optional<std::vector<bool>> fixed(const std::vector<double>& factors) {
  std::vector<bool> is_fixed;
  for (const double factor : factors) {
    if (factor != 1 && factor != kFactor) return std::nullopt;
    is_fixed.push_back(factor == 1);
  }
  return is_fixed;
}

/// Whether it is a voltage that a factor for all moves.
bool is_voltage(const diagram::FlatBlock& block, std::size_t parameter) {
  const auto unit = text::parse_unit(block.definition->parameters[parameter].unit);
  const double value = block.parameters[parameter];
  return unit && unit->exponents[text::Unit::signal] != 0 && value != 0 && std::isfinite(value);
}

}  // namespace

std::optional<LogicPorts> logic_ports(const diagram::FlatBlock& block) {
  if (block.definition->needs.empty()) return std::nullopt;
  const std::vector<double> factors(block.inputs.size(), kFactor);
  const diagram::BlockScaling scaling = diagram::BlockScalingRules(block).from_inputs(factors, kFactor);
  const auto inputs = fixed(scaling.inputs), outputs = fixed(scaling.outputs);
  if (!inputs || !outputs) return std::nullopt;
  for (std::size_t k = 0; k < block.parameters.size(); ++k) {
    if (is_voltage(block, k) && scaling.parameters[k] != kFactor) return std::nullopt;
  }
  LogicPorts ports{*inputs, *outputs, false};
  for (const bool is_fixed : ports.outputs) ports.scales = ports.scales || !is_fixed;
  for (const bool is_fixed : ports.inputs) ports.scales = ports.scales || !is_fixed;
  return ports;
}

}  // namespace oblique::machine
