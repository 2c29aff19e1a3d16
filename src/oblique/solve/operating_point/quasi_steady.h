// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>
#include <oblique/solve/stability/linearisation.h>

namespace oblique::solve {

/// Whether states of such a block are brought to rest before a run: those of servo amplifiers.
bool is_brought_to_rest(const diagram::BlockDefinition& definition);

/// The diagram with servo loops that are infinitely fast: a block whose states are brought to rest before a
/// run and that has a parameter `bandwidth` takes its output from an algebraic loop of the same gain.
diagram::FlatDiagram with_instant_servos(diagram::FlatDiagram diagram);

/// Moments of a run, evenly spread over up to `most` of its rows, at which every servo loop of `program`
/// stands at rest, whether it would stay there or not: where the solution of an unstable diagram lies, which
/// no run of it shows. Throws SolveError where the loops have no solution on the way.
std::vector<Instant> quasi_steady_instants(const network::Program& program,
                                           const diagram::FlatDiagram& diagram, RunOptions options,
                                           std::size_t most);

/// Collects `most` rows, evenly spread, of a run of `options.samples` rows into `instants`, which must
/// outlive the run.
void collect_instants(RunOptions& options, std::size_t most, std::vector<Instant>& instants);

}  // namespace oblique::solve
