// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <oblique/solve/run.h>
#include <oblique/solve/solve_error.h>

#include "compiled.h"

namespace oblique::testing {

/// What a test changes about a run: the plain members of RunOptions.
struct Request {
  double until = 1;
  double tolerance = 1e-8;
  int samples = 1001;
  long max_steps = 10'000'000;
  std::vector<double> extra_times = {};
  diagram::IntegrationMethod method = diagram::IntegrationMethod::automatic;
};

inline solve::Run run_of(const Compiled& made, const Request& request = {}) {
  solve::RunOptions options;
  options.until = request.until;
  options.tolerance = request.tolerance;
  options.samples = request.samples;
  options.max_steps = request.max_steps;
  options.extra_times = request.extra_times;
  options.method = request.method;
  return solve::run(made.program, made.flat, options);
}

/// A column of a trajectory.
inline std::vector<double> column_of(const solve::Trajectory& trajectory, std::string_view name) {
  const std::size_t column = trajectory.find(name).value();
  std::vector<double> values;
  for (std::size_t r = 0; r < trajectory.rows(); ++r) values.push_back(trajectory.at(r, column));
  return values;
}

/// A column of a run, at the rows of its grid.
inline std::vector<double> row_values(const solve::Run& result, std::string_view name) {
  return column_of(result.trajectory, name);
}

/// What a run that fails says.
struct RunFailure {
  solve::SolveError::Kind kind;
  double time;
  std::string message;
};

/// How the run of a diagram fails; nothing where it does not.
inline std::optional<RunFailure> failure_of(const Compiled& made, const Request& request = {}) {
  try {
    run_of(made, request);
  } catch (const solve::SolveError& error) {
    return RunFailure{error.kind(), error.time(), error.what()};
  }
  return std::nullopt;
}

}  // namespace oblique::testing
