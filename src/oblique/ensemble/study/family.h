// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/flatten.h>
#include <oblique/ensemble/study/plan.h>
#include <oblique/solve/run.h>

namespace oblique::ensemble {

/// A run of a family: the same diagram with one value of what is varied.
struct FamilyRun {
  double value = 0;  ///< in `Family::unit`
  solve::Run run;    ///< without rows where it failed
  std::string failure;
};

struct Family {
  std::string name, unit;  ///< of what is varied; unit "1": a pure number
  std::vector<FamilyRun> runs;

  /// "c.gain = 100".
  std::string label(std::size_t k) const;
};

/// Runs a diagram with each value of a grid, in so many threads, with these other overrides. Throws
/// StudyError with the findings about the variation at its place, and what flattening the diagram throws.
Family run_family(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                  const std::vector<diagram::ParameterOverride>& overrides, const Variation& variation,
                  const solve::RunOptions& options, int threads);

}  // namespace oblique::ensemble
