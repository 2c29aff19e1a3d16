// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/mechanism/model/mechanism.h>

namespace oblique::compare {

/// What one element's tolerance does to the point that errs most.
struct BudgetEntry {
  std::string element;    ///< "C.length.tolerance": block and parameter
  double half_width = 0;  ///< within which it scatters, in the parameter's unit
  double error = 0;       ///< root of the mean square of the displacement that it makes there [length unit]
  double share = 0;       ///< of the mean square of the displacement that all make together
  double largest = 0;     ///< `error` of the point and the row where this element's is the largest
};

/// Where the errors of a machine come from whose elements scatter: how far each displaces the points of the
/// mechanism, to the first order in the tolerances. Elements are independent and uniform within their half
/// widths, so that the mean squares of what they do add up.
struct ErrorBudget {
  std::vector<BudgetEntry> entries;  ///< the largest share first
  double error = 0;                  ///< of all together, where it is largest [length unit]
  std::string point;                 ///< which is there, of a diagram the output,
  double drive = 0;           ///< at this value of the first drive [rad] or [length unit], or time [s],
  std::size_t row = 0;        ///< in this row
  std::vector<double> along;  ///< the largest `error` of any point in each row [length unit]
};

struct BudgetOptions {
  std::vector<diagram::BlockFigure> scatters;
  int positions = 361;  ///< of a mechanism: rows over one turn, both ends included
  std::function<void(double fraction)> progress;
};

/// Runs the diagram of a mechanism (as `patch` gives it) once, with the sensitivities to all elements that
/// the scatters name. Throws as `flatten`, `solve_motion` and `run`; SolveError where the sensitivities are
/// not known.
ErrorBudget error_budget(const mechanism::Mechanism& whole, const diagram::Diagram& diagram,
                         const diagram::BlockLibrary& library, const BudgetOptions& options);

/// The same of the outputs of any diagram, each by itself, over the largest value that it has, in the rows of
/// its run: `error` and the errors of the entries are parts of that.
ErrorBudget error_budget(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                         const BudgetOptions& options);

}  // namespace oblique::compare
