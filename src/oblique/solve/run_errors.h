// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/solver.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {

/// The error of an algebraic loop that could not be solved at time t: its members, its gain, the remedy.
/// Where the trouble is with none, that of a slide that goes nowhere.
SolveError loop_error(const network::Program& program, const network::Workspace::Trouble& trouble, double t,
                      const std::string& file);

/// The error of a run that the solver gave up: why, where, and the signals with the largest weighted local
/// errors.
SolveError run_error(const network::Program& program, const SolverFailure& failure, const Solver& solver,
                     const network::Workspace& workspace, const std::string& file);

/// The error of servo loops that do not settle; `worst` are states by how fast they still move, fastest
/// first, and `loop` all states through which their loops close.
SolveError rest_error(const network::Program& program, const std::vector<std::size_t>& worst,
                      const std::vector<double>& states, const std::vector<std::size_t>& loop,
                      const std::string& file);

/// "a, b, …": the first few names of a long list.
std::string shortened(std::vector<std::string> names);

}  // namespace oblique::solve
