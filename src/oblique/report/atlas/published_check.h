// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/solve/run.h>

namespace oblique::report {

/// A published value held against a run.
struct PublishedResult {
  diagram::PublishedValue value;
  double actual = 0;  ///< in the unit in which it was published
  /// Of the run that was made for it; of several values with one such run the first has them.
  std::vector<text::Diagnostic> warnings = {};

  /// The difference as a part of the uncertainty that was stated; not a number where the run gives none.
  double in_uncertainties() const;
  bool met() const { return in_uncertainties() <= 1; }
  /// Met, or the file says why it is not.
  bool is_explained() const { return met() || !value.because.empty(); }
  /// That, or the file says what was tried to explain it.
  bool is_known() const { return is_explained() || !value.tried.empty(); }
};

/// What a run of the diagram as it stands is to be asked for: the published values that set nothing.
std::vector<diagram::Expectation> published_expectations(const diagram::Diagram& diagram);

/// Holds all published values, in their order, against `run`, which was asked for `published_expectations`,
/// and against further runs where they set something; these follow the `overrides` of `run`. Throws as
/// flattening, assembly and runs do.
std::vector<PublishedResult> check_published(const diagram::Diagram& diagram,
                                             const diagram::BlockLibrary& library,
                                             const std::vector<diagram::ParameterOverride>& overrides,
                                             const solve::Run& run);

/// Runs the diagram with these settings, so that `expectations` can be held against it. Throws as above.
solve::Run run_with(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                    const std::vector<diagram::ParameterOverride>& settings,
                    const std::vector<diagram::Expectation>& expectations);

/// What the runs that were made for published values warn of.
std::string warnings_text(const std::vector<PublishedResult>& results, const text::Vocabulary& vocabulary);

/// A value with a digit or two more than its uncertainty tells apart.
std::string number_within(double value, double within);

/// A line for each: what came out, what was published, and the difference as a part of its uncertainty; with
/// the reason where the file gives one.
std::string to_text(const std::vector<PublishedResult>& results);

}  // namespace oblique::report
