// SPDX-License-Identifier: MIT
#include <oblique/machine/realise.h>

#include <oblique/diagram/flatten.h>
#include <oblique/machine/circuit.h>
#include <oblique/machine/element_writer.h>
#include <oblique/machine/mode_control.h>
#include <oblique/machine/own_drains.h>

namespace oblique::machine {

Realisation realise(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                    const diagram::MachineProfile& machine) {
  // What the diagram itself says of its blocks counts, not what another machine would add.
  diagram::Diagram ideal = diagram;
  ideal.machine.profile = "ideal";
  diagram::FlatDiagram flat = diagram::flatten(ideal, library);
  wire_drains(flat);
  prepare_modes(flat, flat, library, machine);
  const Circuit circuit = reduce(flat, library, most_weight_of_one(machine));
  return write_elements(diagram, flat, library, machine, circuit);
}

}  // namespace oblique::machine
