// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>

namespace oblique::solve {

/// A parameter of a flat diagram by which a run is differentiated.
struct SensitivityParameter {
  std::string name;          ///< "c.gain", or "c.in[2]" for a weight
  std::uint32_t number = 0;  ///< as network::ParameterNumbers has it
  double value = 0;          ///< [unit]
  std::string unit;
};

/// Finds parameters by name. Throws text::ReadError for one that there is not, and for one that is infinite.
std::vector<SensitivityParameter> sensitivity_parameters(const diagram::FlatDiagram& diagram,
                                                         const std::vector<std::string>& names);

}  // namespace oblique::solve
