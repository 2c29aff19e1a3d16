// SPDX-License-Identifier: MIT
#include <oblique/compare/patched_run.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

Diagram patch_of(const Mechanism& mechanism, const PatchOptions& options) {
  Diagram diagram = patch(mechanism, options);
  diagram.file = mechanism.file;
  return diagram;
}

}  // namespace

PatchedMechanism::PatchedMechanism(const Mechanism& mechanism, const BlockLibrary& library,
                                   const PatchOptions& patch_options)
    : options(patch_options),
      diagram(patch_of(mechanism, patch_options)),
      flat(flatten(diagram, library)),
      program(assemble(flat)) {}

RecordedRun run_recorded(const PatchedMechanism& patched, double tolerance,
                         const std::function<void(double)>& progress) {
  RecordedRun recorded;
  RunOptions how = options_of(patched.diagram.run);
  how.tolerance = tolerance;
  how.progress = progress;
  how.on_sample = [&](double t, std::span<const double> states, std::span<const double> memories) {
    recorded.instants.push_back({t, {states.begin(), states.end()}, {memories.begin(), memories.end()}});
  };
  try {
    recorded.run = run(patched.program, patched.flat, how);
  } catch (const SolveError& error) {
    Diagnostic finding = error.diagnostics().front();
    finding.place = {patched.flat.file, {}};  // the diagram has no file in which its blocks stand
    const PatchOptions& options = patched.options;
    finding.what =
        fmt::format("with amplifiers of gain {:.6g}{}: {}", options.gain,
                    options.bandwidth ? fmt::format(" and {:.6g} Hz", *options.bandwidth) : "", finding.what);
    throw SolveError(error.kind(), error.time(), std::move(finding));
  }
  return recorded;
}

std::vector<PointOutputs> point_outputs(const Mechanism& mechanism, const FlatDiagram& flat) {
  const auto column = [&](const std::string& name) {
    const auto found = std::find_if(flat.outputs.begin(), flat.outputs.end(),
                                    [&](const FlatOutput& output) { return output.name == name; });
    return static_cast<std::size_t>(found - flat.outputs.begin());
  };
  std::vector<PointOutputs> outputs;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    const Point& point = mechanism.points[p];
    if (!point.fixed) outputs.push_back({p, column(point.name + ".x"), column(point.name + ".y")});
  }
  return outputs;
}

Eigen::Vector2d place_of(const PointOutputs& point, const Trajectory& analog, std::size_t row) {
  return {analog.at(row, 1 + point.x), analog.at(row, 1 + point.y)};  // the first column is the time
}

Distances distances(const Mechanism& mechanism, const FlatDiagram& flat, const Trajectory& analog,
                    const Motion& exact) {
  Distances found;
  double sum = 0;
  std::size_t count = 0;
  for (const PointOutputs& point : point_outputs(mechanism, flat)) {
    for (std::size_t row = 0; row < analog.rows(); ++row, ++count) {
      const Eigen::Vector2d& place = exact.configurations[row].points[point.point].position;
      const double error = (place_of(point, analog, row) - place).norm();
      sum += error * error;
      if (count > 0 && error <= found.largest) continue;
      found.largest = error;
      found.worst = point;
      found.row = row;
    }
  }
  found.rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
  return found;
}

}  // namespace oblique
