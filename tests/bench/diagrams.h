// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

namespace oblique::bench {

/// A chain of `n` servo amplifiers, each tracking the one before it, the first the cosine s0 of an angle that
/// turns ten times:
///
///     one ──► phi ──► s0 ──► s1 ──► s2 ──► … ──► sn        r_k = s_k − s_{k−1}
///
/// Weights of 1 carry the signal to the last block: with 0.9 it would underflow after a few thousand of them,
/// and denormal numbers, not the engine, would be measured. The amplifiers begin at 1, where they are at rest
/// but for 1e-6 a block.
std::string servo_chain_text(int n);

/// Triangles side by side, `n` dyads that one crank drives: 23 primitive blocks each.
std::string dyad_row_text(int n);

/// A diagram with all that `run` needs. `library` must outlive it.
struct CompiledDiagram {
  CompiledDiagram(const diagram::Diagram& diagram, const diagram::BlockLibrary& library)
      : CompiledDiagram(diagram::flatten(diagram, library), solve::options_of(diagram.run)) {}
  CompiledDiagram(diagram::FlatDiagram flattened, solve::RunOptions with)
      : flat(std::move(flattened)), program(network::assemble(flat)), options(std::move(with)) {}

  diagram::FlatDiagram flat;
  network::Program program;
  solve::RunOptions options;
};

/// A run and the CPU time of its parts [s].
struct TimedRun {
  solve::Run run;
  double rest = 0;         ///< to bring the servo loops to rest
  double integration = 0;  ///< all that comes after it: integration and sampling
};

TimedRun timed_run(const CompiledDiagram& diagram);

}  // namespace oblique::bench
