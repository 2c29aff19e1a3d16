// SPDX-License-Identifier: MIT
#include <oblique/compare/error_parts.h>

#include <algorithm>
#include <array>

#include <Eigen/LU>

#include <oblique/network/program/program.h>
#include <oblique/solve/solve_error.h>

namespace oblique::compare {
namespace {

/// How much tighter the run is against which the solver is judged: its errors are then a few hundredths, or
/// some tenths where rounding allows no better.
constexpr std::array kTighter{1e-2, 1e-1};
/// More steps than this many times those of the run are steps of rounding: of the fifth order, a hundredth of
/// the tolerance takes 2.5 times as many.
constexpr long kMostTimes = 20;
/// Farther from the run [machine unit] it would be another solution.
constexpr double kFarthest = 0.1;
constexpr int kMostSteps = 30;

std::optional<RecordedRun> tighter_run(const PatchedMechanism& patched, const solve::Run& run,
                                       const std::function<void(double)>& progress) {
  for (const double part : kTighter) {
    const bool first = part == kTighter.front();  // of a second one there is no progress to be told
    try {
      return run_recorded(patched, "a tighter tolerance", part * patched.diagram.run.tolerance,
                          first ? progress : nullptr, {}, kMostTimes * run.statistics.steps);
    } catch (const solve::SolveError&) {
      continue;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::size_t> tracking_states(const network::Program& program, const diagram::FlatDiagram& flat,
                                         const std::vector<PointOutputs>& points) {
  const auto name_of = [&](std::size_t column) {
    return program.signal_names()[program.signal_index(flat.outputs[column].signal)];
  };
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < program.n_states(); ++i) {
    const network::State& state = program.states()[i];
    const bool is_coordinate = std::any_of(points.begin(), points.end(), [&](const PointOutputs& point) {
      return name_of(point.x) == state.name || name_of(point.y) == state.name;
    });
    if (state.at_rest || is_coordinate) found.push_back(i);
  }
  return found;
}

std::optional<solve::Instant> at_rest(const network::Program& program, const std::vector<std::size_t>& moving,
                                      solve::Instant instant) {
  if (moving.empty()) return instant;
  network::Workspace workspace(program);
  std::vector<double> derivatives(program.n_states());
  const auto n = static_cast<Eigen::Index>(moving.size());
  Eigen::VectorXd right(n), away = Eigen::VectorXd::Zero(n);
  double last = kFarthest;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto linear = solve::Linearisation::at(program, workspace, instant);
    if (!linear || !program.derivatives(instant.t, instant.states.data(), derivatives.data(), workspace))
      return std::nullopt;
    for (Eigen::Index k = 0; k < n; ++k) right[k] = derivatives[moving[static_cast<std::size_t>(k)]];
    const Eigen::VectorXd change = linear->block(moving).partialPivLu().solve(right);
    if (!change.allFinite()) return std::nullopt;
    const double size = change.cwiseAbs().maxCoeff();
    constexpr double kRounding = 1e-12;
    if (size < kRounding && size >= last / 2) return instant;  // no better for another step
    last = size;
    away -= change;
    if (away.cwiseAbs().maxCoeff() > kFarthest) return std::nullopt;
    for (Eigen::Index k = 0; k < n; ++k) instant.states[moving[static_cast<std::size_t>(k)]] -= change[k];
  }
  return std::nullopt;
}

std::optional<ErrorParts> error_parts(const mechanism::Mechanism& mechanism, const PatchedMechanism& patched,
                                      const mechanism::Motion& exact, const solve::Run& analog,
                                      const Distances& error, const std::function<void(double)>& progress) {
  const auto found_tight = tighter_run(patched, analog, progress);
  if (!found_tight) return std::nullopt;
  const RecordedRun& tight = *found_tight;
  const auto rest = at_rest(
      patched.program, tracking_states(patched.program, patched.flat, point_outputs(mechanism, patched.flat)),
      tight.instants[error.row]);
  const auto settled = rest ? place_in(patched, error.worst, *rest) : std::nullopt;
  if (!settled) return std::nullopt;
  const Eigen::Vector2d& there = exact.configurations[error.row].points[error.worst.point].position;
  const Eigen::Vector2d moving = place_of(error.worst, tight.run.trajectory, error.row);
  const Eigen::Vector2d found = place_of(error.worst, analog.trajectory, error.row);
  const Eigen::Vector2d along = (found - there).normalized();
  const auto part = [&](const Eigen::Vector2d& way) { return along.dot(way) + 0.0; };  // −0 + 0 is 0
  return ErrorParts{part(*settled - there), part(moving - *settled), part(found - moving)};
}

}  // namespace oblique::compare
