// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/solve/run.h>

namespace oblique::solve {

/// A number that a run gives.
struct RunNumber {
  enum class Kind {
    value,    ///< of an output at a time: also an extreme, at its time
    integral  ///< of an output over the run [its unit · s]
  };
  Kind kind = Kind::value;
  std::string output;
  double time = 0;  ///< [s] of a value
};

/// What it is, and its derivative by each parameter.
struct Gradient {
  double value = 0;
  std::vector<double> by_parameter;
};

/// The derivatives of one number by many parameters: one run forward and one of the adjoint equations
/// λ′ = −(∂f/∂x)ᵀ λ backward (CVODES), whatever the number of parameters; their integrals λᵀ ∂f/∂p alone are
/// one for each. Of a run that begins as `run` does, is smooth (its switches stay where they are) and lasts
/// until `options.until`, or the time of the value. Names are those of `RunOptions::sensitivity`. Throws
/// ReadError for a name that there is not, and SolveError as `run`, where something turns over, and where
/// derivatives are not known.
Gradient gradient(const network::Program& program, const diagram::FlatDiagram& diagram,
                  const RunOptions& options, const RunNumber& number, const std::vector<std::string>& names);

/// The same of a diagram as it was read, run as its [run] says. Throws DiagramError and NetworkError besides.
Gradient gradient(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                  const RunNumber& number, const std::vector<std::string>& names);

}  // namespace oblique::solve
