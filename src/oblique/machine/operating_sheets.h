// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/sheet.h>

namespace oblique::machine {

/// At which element each output is read, what 1 V there is, and 0 V, in the unit of the output; machine units
/// in the place of volts where their voltage is not published.
Sheet output_sheet(const diagram::FlatDiagram& diagram, const diagram::MachineProfile& machine);

/// The groups of integrators: which they are, by which element a mode line puts them into initial condition
/// or holds them, and their mode in each phase. Without a timeline all operate for `until` seconds.
Sheet mode_sheet(const diagram::FlatDiagram& diagram, double until, const diagram::MachineProfile& machine);

}  // namespace oblique::machine
