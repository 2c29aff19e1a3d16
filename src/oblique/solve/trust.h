// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>

namespace oblique::diagram {
struct FlatDiagram;
}
namespace oblique::network {
class Program;
}

namespace oblique::solve {

struct Run;
struct RunOptions;

/// How far an output of a run may be from the solution of its equations, in the unit of the output.
struct OutputError {
  std::string name;
  double size = 0;     ///< the largest magnitude of the output at the rows
  double largest = 0;  ///< error over all rows
  double at_end = 0;   ///< over the last twentieth of them: the last alone may be right by chance
  std::optional<double>
      lost;  ///< [s] the first row with an error above a tenth of `size`: no digit stands there

  /// Decimal digits of `size` that an error of this size leaves, from 0 to 15.
  int digits(double error) const;
};

/// The global error of a run, estimated by others that are finer.
struct Trust {
  struct Check {
    double tolerance = 0;
    diagram::IntegrationMethod method =
        diagram::IntegrationMethod::adams;  ///< for a diagram without states of no meaning
  };
  std::vector<Check> checks;          ///< the runs that were held beside it; none: there is no estimate
  std::vector<OutputError> outputs;   ///< in the order of the diagram
  double event_shift = 0;             ///< [s] by which the times of events differ at most
  std::optional<double> events_part;  ///< [s] from where on the runs do not have the same events
  bool has_states = true;             ///< else rounding alone errs, and every run alike
  std::string failure;                ///< why a check did not come to its end; empty: all did
};

/// Estimates the error of `done`, the run of these options, by running again at a finer tolerance, and once
/// more so by Rodas5P (of a run by that, by CVODES) where that takes no more than some twenty times the
/// steps: the largest difference of each output. A method's error and its tolerance fall together, so that
/// the first is known to a few per cent where the equations are smooth; the second does not share what one
/// method does wrong. (The other family of CVODES would be the less accurate of the two, by a hundred times
/// beside 1e-11, and Adams' formulas do not come through stiff equations.) Rows between the times at which
/// two runs have the same event are left out: there an output that jumps has jumped in one of them. Whatever
/// all the runs miss alike (a pulse between their steps) is not in the estimate.
Trust estimate_error(const network::Program& program, const diagram::FlatDiagram& diagram,
                     const RunOptions& options, const Run& done);

}  // namespace oblique::solve
