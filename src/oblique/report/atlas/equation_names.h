// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/assembly/network.h>

namespace oblique::report {

/// A quantity of the circuit: `factor` times what is called `name`.
struct Quantity {
  std::string name;
  double factor = 1;
};

/// What the equations of a circuit are written in. Not installed.
struct EquationNames {
  struct Output {
    std::string name;
    network::NodeId node;
    double scale, offset;
  };

  std::vector<Quantity> variables;  ///< time, states, unknowns; by the outputs that show them
  std::unordered_map<network::NodeId, Quantity>
      signals;                                 ///< that are no variables, by their blocks or outputs
  std::unordered_set<network::NodeId> apart;   ///< of `signals`: those with an equation of their own
  std::vector<network::NodeId> apart_outputs;  ///< of `apart`: those that are outputs, once each
  std::vector<Output> other_outputs;           ///< that neither show a variable nor name what stands apart
};

/// Names for the equations of `diagram`, which is `network`. What several equations need, or what is long,
/// has an equation of its own.
EquationNames name_equations(const network::Network& network, const diagram::FlatDiagram& diagram);

}  // namespace oblique::report
