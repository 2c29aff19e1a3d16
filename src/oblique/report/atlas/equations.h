// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>

namespace oblique::report {

/// An equation that a circuit solves: `left` = `right`, in the language of expressions as long as nothing in
/// it switches.
struct RecoveredEquation {
  std::string left;          ///< "der(x)", "xy", "0"
  std::string right;         ///< "10*y - 10*x"
  std::string start;         ///< of a state: its initial value; empty where it follows from signals
  std::string unknown = {};  ///< of an equation "0 = …": what it is solved for
};

/// The same circuit where every integrator operates all the time and no amplifier saturates.
diagram::FlatDiagram as_operated(diagram::FlatDiagram diagram);

/// The equations of a circuit as it is operated, read back from its wires: summers, coefficients, signs and
/// scale factors are multiplied out. A signal that is an output stands as that output, in its unit; t is the
/// time of the run. What several equations need has an equation of its own, by the name of its signal.
/// Numbers have `digits` significant digits. Throws NetworkError.
std::vector<RecoveredEquation> recovered_equations(const diagram::FlatDiagram& diagram, int digits = 6);

/// The points of table1, table2 … in these equations, in machine units.
std::vector<text::PointTable> recovered_tables(const diagram::FlatDiagram& diagram);

}  // namespace oblique::report
