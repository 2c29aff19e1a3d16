// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/machine/circuit.h>
#include <oblique/machine/realise.h>

// Not installed.
namespace oblique::machine {

/// What an input can weigh that takes one signal alone; none: any weight.
std::vector<double> gains_of_one(const diagram::MachineProfile& machine);

/// The greatest weight there.
double most_weight_of_one(const diagram::MachineProfile& machine);

/// Writes a circuit in the elements of a machine, as `realise` says. `flat` is the diagram that the circuit
/// was reduced from; of `diagram` come the run, what is expected, titles and comments.
Realisation write_elements(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
                           const diagram::BlockLibrary& library, const diagram::MachineProfile& machine,
                           const Circuit& circuit);

}  // namespace oblique::machine
