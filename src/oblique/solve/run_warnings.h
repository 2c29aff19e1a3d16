// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/solve/run.h>

namespace oblique::solve {

/// What is to be told of a whole run: points over the time that it goes beyond, cycles of a timeline that it
/// does not come to, a tolerance that is too coarse for its method, and an integrator that follows its
/// initial value too slowly for its phases.
std::vector<text::Diagnostic> warnings_at_end(const diagram::FlatDiagram& diagram, const RunOptions& options,
                                              const Run& run);

}  // namespace oblique::solve
