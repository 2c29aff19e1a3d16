// SPDX-License-Identifier: MIT
#include <oblique/compare/compare.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/mechanism/motion.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability.h>

namespace oblique {
namespace {

constexpr std::size_t kRowsPerStabilityCheck = 10;
constexpr double kAboveFloor = 10;
/// Amplifiers of this gain err by far less than what the tolerance of any run leaves. Ideal ones would not do
/// for the floor: without the dynamics of the loops there are fewer errors to add up, ten times fewer in a
/// Jansen leg.
constexpr double kFloorGain = 1e12;

/// The columns of a trajectory that belong to a moving point.
struct PointColumns {
  std::size_t point;
  std::size_t x, y;
};

std::vector<PointColumns> point_columns(const Mechanism& mechanism, const Trajectory& trajectory) {
  std::vector<PointColumns> columns;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    const Point& point = mechanism.points[p];
    if (point.fixed) continue;
    columns.push_back(
        {p, trajectory.find(point.name + ".x").value(), trajectory.find(point.name + ".y").value()});
  }
  return columns;
}

void measure_errors(const Mechanism& mechanism, const Trajectory& analog, const Motion& exact,
                    GainRun& result) {
  double sum = 0;
  std::size_t count = 0;
  for (const PointColumns& columns : point_columns(mechanism, analog)) {
    for (std::size_t row = 0; row < analog.rows(); ++row, ++count) {
      const Eigen::Vector2d& place = exact.configurations[row].points[columns.point].position;
      const double error =
          std::hypot(analog.at(row, columns.x) - place.x(), analog.at(row, columns.y) - place.y());
      sum += error * error;
      if (error <= result.max_error) continue;
      result.max_error = error;
      result.worst_point = mechanism.points[columns.point].name;
      result.worst_time = analog.at(row, 0);
    }
  }
  result.rms_error = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
}

Run run_naming_gain(const Program& program, const FlatDiagram& flat, const RunOptions& options, double gain) {
  try {
    return run(program, flat, options);
  } catch (const SolveError& error) {
    Diagnostic finding = error.diagnostics().front();
    finding.place = {flat.file, {}};  // the diagram has no file in which its blocks stand
    finding.what = fmt::format("with amplifiers of gain {:.6g}: {}", gain, finding.what);
    throw SolveError(error.kind(), error.time(), std::move(finding));
  }
}

GainRun run_with_gain(const Mechanism& mechanism, const BlockLibrary& library, const Motion& exact,
                      PatchMethod method, double gain, const std::function<void(double)>& progress) {
  PatchOptions patch_options;
  patch_options.method = method;
  patch_options.gain = gain;
  patch_options.samples = static_cast<int>(exact.times.size());
  Diagram diagram = patch(mechanism, patch_options);
  diagram.file = mechanism.file;
  const FlatDiagram flat = flatten(diagram, library);
  const Program program(assemble(flat));

  GainRun result;
  result.gain = gain;
  result.slowest_pole = -std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, std::vector<double>>> checkpoints;
  std::size_t row = 0;
  RunOptions options = options_of(diagram.run);
  options.progress = progress;
  options.on_sample = [&](double t, std::span<const double> states, std::span<const double>) {
    if (row++ % kRowsPerStabilityCheck == 0)
      checkpoints.emplace_back(t, std::vector(states.begin(), states.end()));
  };
  const Run analog = run_naming_gain(program, flat, options, gain);
  result.steps = analog.statistics.steps;
  result.seconds = analog.seconds;
  for (std::size_t s = 0; s < analog.peaks.size(); ++s) {
    if (std::abs(analog.peaks[s].value) > 1 + kOverloadMargin) {
      result.overloads.push_back({program.signal_names()[s], analog.peaks[s]});
    }
  }
  Workspace frozen(program);
  for (const auto& [t, states] : checkpoints) {
    const double pole = servo_stability(program, frozen, t, states);
    result.slowest_pole = std::max(result.slowest_pole, pole);
    result.stable = result.stable && pole < 0;
  }
  measure_errors(mechanism, analog.trajectory, exact, result);
  return result;
}

/// Least-squares slope of log error over log gain among the runs that the floor does not hide.
std::optional<double> fitted_order(const std::vector<GainRun>& runs, double floor) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const GainRun& run : runs) {
    if (run.max_error < kAboveFloor * floor || !std::isfinite(run.gain)) continue;
    const double x = std::log10(run.gain), y = std::log10(run.max_error);
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 2 || spread <= 0) return std::nullopt;
  return (n * sxy - sx * sy) / spread;
}

}  // namespace

Comparison compare(const Mechanism& mechanism, const BlockLibrary& library, const CompareOptions& options) {
  Comparison comparison;
  comparison.mechanism = mechanism.title;
  comparison.method = options.method;
  comparison.unit = mechanism.length_unit;
  comparison.size = mechanism.largest_length();
  comparison.bandwidth = default_bandwidth(mechanism);
  const Motion exact = solve_motion(mechanism, options.positions);

  const auto total = static_cast<double>(options.gains.size() + 1);
  double done = 0;
  const auto progress = [&](double fraction) {
    if (options.progress) options.progress((done + fraction) / total);
  };
  for (const double gain : options.gains) {
    comparison.runs.push_back(run_with_gain(mechanism, library, exact, options.method, gain, progress));
    progress(1);
    ++done;
  }
  comparison.floor = run_with_gain(mechanism, library, exact, options.method, kFloorGain, progress).max_error;
  comparison.order = fitted_order(comparison.runs, comparison.floor);
  return comparison;
}

}  // namespace oblique
