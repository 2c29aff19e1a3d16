// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/solve/run.h>

namespace oblique::solve {

/// What the end of a run leaves of what its diagram asks for: points over the time that the run goes beyond,
/// and cycles of a timeline that it does not come to.
std::vector<text::Diagnostic> warnings_at_end(const diagram::FlatDiagram& diagram, const RunOptions& options,
                                              const Run& run);

}  // namespace oblique::solve
