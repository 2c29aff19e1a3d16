// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/signal_ranges.h>

// Not installed.
namespace oblique::machine {

/// A function that a function generator stands for.
struct TabulatedFunction {
  std::string path;          ///< of the block that was one
  std::string block;         ///< its kind: "cosine"
  int segments = 0;          ///< straight lines
  double low = 0, high = 0;  ///< range of its argument over the run [machine unit of the diagram; s of time]
  double error = 0;  ///< greatest distance of the lines from the function [machine unit of the diagram]
};

/// Whether blocks of a role may become others where they are functions: what has no role, and function
/// generators where the machine has none.
bool may_be_tabulated(diagram::Role role, const diagram::MachineProfile& machine);

/// Puts function generators of at most `segments` straight lines in the place of blocks without a role whose
/// outputs are functions of one signal, or of time, and of nothing else: for time an integrator of a constant
/// is added, "clock". What is a straight line itself becomes a summer; what has a few corners and is straight
/// between them, also a function generator, comparators and multipliers, where the machine has these and no
/// function generators; a formula of the time that is neither the circuit that draws it (`time_circuit`),
/// where there is one. `ranges` are those of the signals of `flat` (`signal_ranges`), which is run for
/// `until` [s]. Throws RealiseError for a function that jumps, is not finite somewhere in the range, or that
/// so many lines miss.
std::vector<TabulatedFunction> tabulate_functions(diagram::FlatDiagram& flat,
                                                  const diagram::BlockLibrary& library,
                                                  const diagram::MachineProfile& machine,
                                                  const std::vector<SignalRange>& ranges, double until,
                                                  int segments);

}  // namespace oblique::machine
