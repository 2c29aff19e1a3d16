// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/scaled_realisation.h>
#include <oblique/machine/sheet.h>
#include <oblique/solve/static_test.h>

namespace oblique::machine {

/// What a machine room works from. Elements have the numbers that `realise` gives them as labels: A1 …
/// amplifiers, P1 … potentiometers, M1 … multipliers, K1 … comparators, F1 … function generators, X1 …
/// others; +REF and −REF are the reference.
struct MachineSheets {
  Sheet connections;     ///< from output to input, with the gain of the input
  Sheet potentiometers;  ///< settings to four digits, and what they stand for
  Sheet static_test;  ///< what everything is and shows at t = 0 [V], with derivatives of integrators [V/s];
                      ///< in machine units where their voltage is not published
  Sheet functions;    ///< of function generators: value and slope at 0, breakpoints and slopes from there
                      ///< outwards
  Sheet outputs;      ///< where each output is read, and what a volt of it stands for
  Sheet modes;        ///< how long and in which mode each group of integrators is; of `sheets_of`
};

/// `diagram` is flattened from one that `realise` has made; `readings` are its `static_test`.
MachineSheets make_sheets(const diagram::FlatDiagram& diagram,
                          const std::vector<solve::StaticReading>& readings,
                          const diagram::MachineProfile& machine);

/// The same for a diagram in elements of the machine, with what the ideal machine would show as the readings.
MachineSheets sheets_of(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
                        const diagram::BlockLibrary& library, const diagram::MachineProfile& machine);

/// What the elements of a diagram that was scaled for the machine stand for, and how far they go.
Sheet scale_sheet(const ScaledRealisation& made, const diagram::MachineProfile& machine);

}  // namespace oblique::machine
