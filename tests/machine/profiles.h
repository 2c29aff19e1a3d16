// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include <oblique/diagram/machine_profile.h>

namespace oblique::testing {

/// A machine whose summers and integrators invert, with inputs of 1 and 10 and as many elements as it takes;
/// its name is that of the ideal machine, so that nothing it is made of has errors.
inline diagram::MachineProfile inverting_machine() {
  diagram::MachineProfile machine;
  machine.name = "ideal";
  machine.title = "Machine";
  machine.input_gains = {1, 10};
  for (const diagram::ElementKind kind :
       {diagram::ElementKind::amplifier, diagram::ElementKind::integrator,
        diagram::ElementKind::potentiometer, diagram::ElementKind::multiplier,
        diagram::ElementKind::comparator, diagram::ElementKind::function_generator})
    machine.elements.push_back({kind, std::numeric_limits<double>::infinity(), {}});
  return machine;
}

/// Likewise, with coefficients from −1 to 1.
inline diagram::MachineProfile signed_machine() {
  diagram::MachineProfile machine = inverting_machine();
  machine.signed_coefficients = true;
  return machine;
}

/// Inverting, with inputs of 1 and 10 and integrators of 1 to 1000 1/s.
inline diagram::MachineProfile desk_machine() {
  diagram::MachineProfile machine = inverting_machine();
  machine.rates = {1, 10, 100, 1000};
  return machine;
}

}  // namespace oblique::testing
