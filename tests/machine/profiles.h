// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include <oblique/diagram/machine_profile.h>

namespace oblique::testing {

/// A machine whose summers and integrators invert, with inputs of 1 and 10 and as many elements as it takes;
/// its name is that of the ideal machine, so that nothing it is made of has errors.
inline MachineProfile inverting_machine() {
  MachineProfile machine;
  machine.name = "ideal";
  machine.title = "Machine";
  machine.input_gains = {1, 10};
  for (const ElementKind kind :
       {ElementKind::amplifier, ElementKind::integrator, ElementKind::potentiometer, ElementKind::multiplier,
        ElementKind::comparator, ElementKind::function_generator})
    machine.elements.push_back({kind, std::numeric_limits<double>::infinity(), {}});
  return machine;
}

/// Likewise, with coefficients from −1 to 1.
inline MachineProfile signed_machine() {
  MachineProfile machine = inverting_machine();
  machine.signed_coefficients = true;
  return machine;
}

}  // namespace oblique::testing
