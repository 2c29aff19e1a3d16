// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/solve/run.h>

namespace oblique::mechanism {
struct MechanismFinding;
}

namespace oblique::report {

/// One line of `[expect]` held against a run.
struct ExpectationResult {
  diagram::Expectation expectation;
  double actual = 0;
  bool met = false;
};

/// The times that `[expect]` asks for, ascending: the `extra_times` of the run. Throws DiagramError for a
/// time outside [0, until].
std::vector<double> expectation_times(const diagram::Diagram& diagram, double until);

/// The same of any expectations.
std::vector<double> expectation_times(std::span<const diagram::Expectation> expectations, double until);

/// Lets a run keep what `check_expectations` looks at; `file` is the diagram's. Throws DiagramError as above.
void ask_for_expectations(std::span<const diagram::Expectation> expectations, const std::string& file,
                          solve::RunOptions& options);

/// The same of `[expect]`.
void ask_for_expectations(const diagram::Diagram& diagram, solve::RunOptions& options);

/// Checks every expectation; `run` was made after `ask_for_expectations`. Throws DiagramError for an output
/// that is not among the columns.
std::vector<ExpectationResult> check_expectations(std::span<const diagram::Expectation> expectations,
                                                  const solve::Run& run);

/// The same of `[expect]`.
std::vector<ExpectationResult> check_expectations(const diagram::Diagram& diagram, const solve::Run& run);

/// A line for each: whether it was met, what came out and what was expected.
std::string to_text(const std::vector<ExpectationResult>& results);
std::string to_text(const std::vector<mechanism::MechanismFinding>& findings);

}  // namespace oblique::report
