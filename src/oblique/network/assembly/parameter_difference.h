// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/assembly/parameter_numbers.h>

// Not installed.
namespace oblique::network {

/// The parameters and weights by which `now` differs from `before`, whose numbers are given; nothing where it
/// differs in more: in blocks, wires, tables, formulas, phases. Outputs are not looked at.
std::optional<std::vector<std::uint32_t>> parameter_difference(const diagram::FlatDiagram& before,
                                                               const ParameterNumbers& numbers,
                                                               const diagram::FlatDiagram& now);

}  // namespace oblique::network
