// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/machine/logic_ports.h>
#include <oblique/machine/role.h>

namespace oblique::machine {

/// weight · signal, of the reference (1 machine unit) where there is no signal.
struct CircuitTerm {
  double weight = 1;
  std::optional<diagram::SignalRef> signal;  ///< an element of the circuit and an output of it
};

/// What arrives at an input, each signal once.
struct CircuitInput {
  bool open = false;  ///< unconnected: the block's default applies
  std::vector<CircuitTerm> terms;
};

/// An active element: all that only multiplies by a constant has become part of the weights.
struct CircuitElement {
  Role role = Role::summer;
  std::string path;                            ///< in the flat diagram; of a scaler the signal that it scales
  const diagram::FlatBlock* block = nullptr;   ///< whose parameters it has; none for a scaler
  const diagram::BlockDefinition* definition;  ///< what it is now: of a gain on a loop that of the summer
  double polarity = 1;                         ///< of the equation as the diagram means it
  std::vector<CircuitInput> inputs;            ///< in the order of the definition
  std::optional<LogicPorts> logic;             ///< of a block without a role that stays as it is
};

/// A diagram in active elements and weighted connections, with no machine in mind.
struct Circuit {
  std::vector<CircuitElement> elements;
  std::vector<CircuitTerm> outputs;       ///< one for each output of the flat diagram
  std::vector<CircuitTerm> mode_sources;  ///< one for each of its `mode_signals`
};

/// Reduces a flat diagram: constants become weights of the reference; potentiometers, gains, inverters and
/// summers that pass on one signal with a weight of at most 1 become part of the weights; products with a
/// constant too; a product formed twice is formed once. An input that takes one signal with a weight of at
/// most `most_weight` gets an amplifier, a scaler, where the weight is greater. Elements with imperfections
/// of their own stay. `flat` and `library` must outlive the result. Throws RealiseError for potentiometers
/// with imperfections of their own.
Circuit reduce(const diagram::FlatDiagram& flat, const diagram::BlockLibrary& library, double most_weight);

}  // namespace oblique::machine
