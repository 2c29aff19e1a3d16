// SPDX-License-Identifier: MIT
#include <oblique/compare/patched_run.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability/stability.h>

namespace oblique::compare {
namespace {

constexpr std::size_t kRowsPerStabilityCheck = 10;

}  // namespace

diagram::Diagram patch_named(const mechanism::Mechanism& mechanism, const patch::PatchOptions& options) {
  diagram::Diagram diagram = patch::patch(mechanism, options);
  diagram.file = mechanism.file;
  return diagram;
}

PatchedMechanism::PatchedMechanism(diagram::Diagram patched, const diagram::BlockLibrary& library)
    : diagram(std::move(patched)),
      flat(diagram::flatten(diagram, library)),
      program(network::assemble(flat)) {}

std::vector<Overload> overloads_of(const network::Program& program, const solve::Run& run, double margin) {
  std::vector<Overload> overloads;
  for (std::size_t s = 0; s < run.peaks.size(); ++s) {
    if (std::abs(run.peaks[s].value) > 1 + margin)
      overloads.push_back({program.signal_names()[s], run.peaks[s]});
  }
  return overloads;
}

double slowest_pole_of(const network::Program& program, const std::vector<solve::Instant>& instants) {
  double slowest = -std::numeric_limits<double>::infinity();
  network::Workspace workspace(program);
  for (std::size_t row = 0; row < instants.size(); row += kRowsPerStabilityCheck) {
    workspace.load_discrete_states(instants[row].discrete_states);
    const double pole = solve::servo_stability(program, workspace, instants[row].t, instants[row].states);
    if (std::isnan(pole)) return pole;
    slowest = std::max(slowest, pole);
  }
  return slowest;
}

RecordedRun run_recorded(const PatchedMechanism& patched, const std::string& what, double tolerance,
                         const std::function<void(double)>& progress, const std::vector<double>& moments,
                         std::optional<std::int64_t> max_steps) {
  RecordedRun recorded;
  solve::RunOptions how = solve::options_of(patched.diagram.run);
  how.tolerance = tolerance;
  how.progress = progress;
  how.extra_times = moments;
  how.max_steps = max_steps.value_or(how.max_steps);
  if (!moments.empty()) how.until = std::max(how.until, moments.back());
  how.on_sample = [&](double t, std::span<const double> states, std::span<const double> discrete_states) {
    recorded.instants.push_back(
        {t, {states.begin(), states.end()}, {discrete_states.begin(), discrete_states.end()}});
  };
  how.on_restart = [&] { recorded.instants.clear(); };
  try {
    recorded.run = solve::run(patched.program, patched.flat, how);
  } catch (const solve::SolveError& error) {
    text::Diagnostic finding = error.diagnostics().front();
    finding.place = {patched.flat.file, {}};  // the diagram has no file in which its blocks stand
    finding.what = fmt::format("with {}: {}", what, finding.what);
    throw solve::SolveError(error.kind(), error.time(), std::move(finding));
  }
  return recorded;
}

std::vector<PointOutputs> point_outputs(const mechanism::Mechanism& mechanism,
                                        const diagram::FlatDiagram& flat) {
  const auto column = [&](const std::string& name) {
    const auto found = std::find_if(flat.outputs.begin(), flat.outputs.end(),
                                    [&](const diagram::FlatOutput& output) { return output.name == name; });
    return static_cast<std::size_t>(found - flat.outputs.begin());
  };
  std::vector<PointOutputs> outputs;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    const mechanism::Point& point = mechanism.points[p];
    if (!point.fixed) outputs.push_back({p, column(point.name + ".x"), column(point.name + ".y")});
  }
  return outputs;
}

std::optional<Eigen::Vector2d> place_in(const PatchedMechanism& patched, const PointOutputs& point,
                                        const solve::Instant& instant) {
  network::Workspace workspace(patched.program);
  std::vector<double> signals(patched.program.n_signals());
  workspace.load_discrete_states(instant.discrete_states);
  if (!patched.program.signals(instant.t, instant.states.data(), signals.data(), workspace))
    return std::nullopt;
  const auto value = [&](std::size_t column) {
    const diagram::FlatOutput& output = patched.flat.outputs[column];
    return output.scale * signals[patched.program.signal_index(output.signal)] + output.offset;
  };
  return Eigen::Vector2d(value(point.x), value(point.y));
}

Eigen::Vector2d place_of(const PointOutputs& point, const solve::Trajectory& analog, std::size_t row) {
  return {analog.at(row, 1 + point.x), analog.at(row, 1 + point.y)};  // the first column is the time
}

Distances distances(const mechanism::Mechanism& mechanism, const diagram::FlatDiagram& flat,
                    const solve::Trajectory& analog, const mechanism::Motion& exact) {
  return distances(point_outputs(mechanism, flat), analog.values(), analog.columns().size(), exact);
}

Distances distances(const std::vector<PointOutputs>& points, std::span<const double> rows,
                    std::size_t columns, const mechanism::Motion& exact) {
  Distances found;
  const std::size_t n_rows = rows.size() / columns;
  found.along.assign(n_rows, 0);
  double sum = 0;
  std::size_t count = 0;
  for (const PointOutputs& point : points) {
    for (std::size_t row = 0; row < n_rows; ++row, ++count) {
      const double* const values = &rows[row * columns + 1];  // the first column is the time
      const Eigen::Vector2d& place = exact.configurations[row].points[point.point].position;
      const double error = (Eigen::Vector2d(values[point.x], values[point.y]) - place).norm();
      sum += error * error;
      found.along[row] = std::max(found.along[row], error);
      if (count > 0 && error <= found.largest) continue;
      found.largest = error;
      found.worst = point;
      found.row = row;
    }
  }
  found.rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
  return found;
}

double largest_of(const solve::Trajectory& run, std::size_t column) {
  double largest = 0;
  for (std::size_t row = 0; row < run.rows(); ++row)
    largest = std::max(largest, std::abs(run.at(row, column)));
  return largest;
}

Distances relative_distances(std::span<const double> rows, const solve::Trajectory& reference) {
  const std::size_t columns = reference.columns().size();
  Distances found;
  found.along.assign(reference.rows(), 0);
  double sum = 0;
  std::size_t number = 0;
  for (std::size_t column = 1; column < columns; ++column) {
    const double size = largest_of(reference, column);
    if (size == 0) continue;
    for (std::size_t row = 0; row < reference.rows(); ++row) {
      const double distance = std::abs(rows[row * columns + column] - reference.at(row, column)) / size;
      sum += distance * distance;
      ++number;
      found.along[row] = std::max(found.along[row], distance);
      if (distance <= found.largest && number > 1) continue;
      found.largest = distance;
      found.worst.point = column - 1;
      found.row = row;
    }
  }
  found.rms = number > 0 ? std::sqrt(sum / static_cast<double>(number)) : 0;
  return found;
}

}  // namespace oblique::compare
