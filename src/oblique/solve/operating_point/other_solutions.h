// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// From where the solution of one algebraic loop is first sought: without a loop, from the guesses of the
/// diagram.
struct LoopStart {
  std::optional<std::size_t> loop;
  std::vector<double> unknowns;  ///< of that loop
  bool goes = true;              ///< whether loops without amplifiers go where their elements take them
};

/// What a start leads to.
struct StartOutcome {
  std::vector<double> unknowns, signals;  ///< of the whole program
  std::vector<bool> runs_away;            ///< of each loop: its elements do not stay there
};

/// One start: what it leads to, nothing where it fails, and how often the equations of loops were evaluated
/// for it.
struct StartAttempt {
  std::optional<StartOutcome> outcome;
  std::size_t loop_evaluations = 0;
};

/// From where the loops of a run are to start, and what else might have been.
struct StartChoice {
  LoopStart from;
  std::vector<text::Diagnostic> warnings;
};

/// A warning for each loop of elements without memory that has another solution where the run starts, at time
/// t. Nothing in such a loop says which one is meant: a servo amplifier has its `initial`, and an equation of
/// a block its guess, so loops with these are left out. Sought from points that fill the machine's range
/// evenly; a solution that lies in no reach of them is not seen. Where starts take very many evaluations, as
/// where loops have no solution on the way, fewer points are tried.
///
/// `start` makes a whole start of its own, with all switches settled and all amplifiers at rest, and gives
/// the unknowns of the program as it leaves them; nothing where it fails. So only what the whole diagram
/// agrees with is a solution, and a loop counts whose choice decides where amplifiers come to rest. Where the
/// guesses lead to no start, or to one where elements would run away, the first point from which the loops go
/// to a better one is chosen.
StartChoice choose_start(const network::Program& program, double t, const std::string& file,
                         const std::function<StartAttempt(const LoopStart&)>& start);

}  // namespace oblique::solve
