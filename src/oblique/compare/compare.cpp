// SPDX-License-Identifier: MIT
#include <oblique/compare/compare.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include <fmt/format.h>

#include <oblique/compare/branch.h>
#include <oblique/compare/error_parts.h>
#include <oblique/compare/judge.h>
#include <oblique/compare/patched_run.h>
#include <oblique/compare/worst_reason.h>
#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

/// Amplifiers of this gain err by far less than what the tolerance of any run leaves. Ideal ones would not do
/// for the floor: without the dynamics of the loops there are fewer errors to add up, ten times fewer in a
/// Jansen leg.
constexpr double kFloorGain = 1e12;

/// The runs of a comparison, one after the other.
class Comparer {
 public:
  Comparer(const Mechanism& mechanism, const BlockLibrary& library, const CompareOptions& options,
           const Structure& structure, const Motion& exact, const WorstReasons& reasons)
      : mechanism_(mechanism),
        library_(library),
        options_(options),
        structure_(structure),
        exact_(exact),
        reasons_(reasons) {}

  ComparedRun compared(const PatchOptions& options) {
    const PatchedMechanism patched(patch_named(mechanism_, options), library_);
    const RecordedRun recorded = run_recorded(patched, name_of(options), options.tolerance, progress());
    finish_run();
    const Run& analog = recorded.run;
    ComparedRun result;
    result.method = options.method;
    result.gain = options.gain;
    result.bandwidth = options.bandwidth.value_or(default_bandwidth(mechanism_));
    result.steps = analog.statistics.steps;
    result.seconds = analog.seconds;
    result.overloads = overloads_of(patched.program, analog);
    result.slowest_pole = slowest_pole_of(patched.program, recorded.instants);
    result.stable = result.slowest_pole < 0;
    const Distances error = distances(mechanism_, patched.flat, analog.trajectory, exact_);
    result.max_error = error.largest;
    result.rms_error = error.rms;
    result.error_along = error.along;
    result.worst = {mechanism_.points[error.worst.point].name, exact_.times[error.row],
                    exact_.drives[error.row].front().value,
                    reasons_.reason(patched, options, recorded, error)};
    const auto off =
        row_off_branch(mechanism_, structure_, patched.flat, analog.trajectory, exact_, error.along);
    if (off) result.left_branch = exact_.drives[*off].front().value;
    result.parts = error_parts(mechanism_, patched, exact_, analog, error, progress());
    finish_run();
    return result;
  }

  std::optional<double> floor(PatchOptions options) {
    options.gain = kFloorGain;
    try {
      const PatchedMechanism patched(patch_named(mechanism_, options), library_);
      const RecordedRun recorded = run_recorded(patched, name_of(options), options.tolerance, progress());
      finish_run();
      return distances(mechanism_, patched.flat, recorded.run.trajectory, exact_).largest;
    } catch (const SolveError&) {  // nobody asked for this run
      finish_run();
      return std::nullopt;
    }
  }

 private:
  /// "amplifiers of gain 1000 and 20 Hz, method gradient": bandwidth and method where there was a choice.
  std::string name_of(const PatchOptions& options) const {
    std::string name = fmt::format("amplifiers of gain {:.6g}", options.gain);
    if (options.bandwidth) name += fmt::format(" and {:.6g} Hz", *options.bandwidth);
    if (options_.methods.size() > 1) name += fmt::format(", method {}", method_name(options.method));
    return name;
  }

  void finish_run() {
    ++done_;
    if (options_.progress) progress()(0);
  }

  std::function<void(double)> progress() const {
    if (!options_.progress) return {};
    const auto bandwidths = std::max<std::size_t>(options_.bandwidths.size(), 1);
    const auto total =
        static_cast<double>(options_.methods.size() * bandwidths * (2 * options_.gains.size() + 1));
    return [this, total](double fraction) { options_.progress((done_ + fraction) / total); };
  }

  const Mechanism& mechanism_;
  const BlockLibrary& library_;
  const CompareOptions& options_;
  const Structure& structure_;
  const Motion& exact_;
  const WorstReasons& reasons_;
  double done_ = 0;  ///< runs
};

/// Least-squares slope of log error over log gain among the runs that the floor does not hide.
std::optional<double> fitted_order(std::span<const ComparedRun> runs, double floor) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const ComparedRun& run : runs) {
    if (run.left_branch || !stands_clear(run.max_error, floor) || !std::isfinite(run.gain)) continue;
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

Comparison compare_within_range(const Mechanism& mechanism, const BlockLibrary& library,
                                const CompareOptions& options) {
  Comparison comparison;
  comparison.mechanism = mechanism.title;
  comparison.unit = mechanism.length_unit;
  comparison.size = mechanism.largest_length();
  const Structure structure = decompose(mechanism);
  comparison.closed_form = std::none_of(structure.groups.begin(), structure.groups.end(),
                                        [](const Group& group) { return group.kind == GroupKind::general; });
  comparison.turning = mechanism.drives.empty() || !mechanism.drives.front().slide;
  const Motion exact = solve_motion(mechanism, options.positions);
  for (const auto& drives : exact.drives) comparison.drive.push_back(drives.front().value);
  const WorstReasons reasons(mechanism, exact);
  Comparer comparer(mechanism, library, options, structure, exact, reasons);
  std::vector<std::optional<double>> bandwidths(options.bandwidths.begin(), options.bandwidths.end());
  if (bandwidths.empty()) bandwidths.emplace_back();
  std::exception_ptr first_refusal;
  const auto refuse = [&](const PatchOptions& asked, std::optional<double> gain, const Error& error) {
    comparison.refused.push_back({asked.method, asked.bandwidth, gain, error.diagnostics().front()});
    if (!first_refusal) first_refusal = std::current_exception();
  };
  for (const PatchMethod method : options.methods) {
    for (const std::optional<double>& bandwidth : bandwidths) {
      PatchOptions asked;
      asked.method = method;
      asked.bandwidth = bandwidth;
      asked.samples = options.positions;
      asked.gain = *std::max_element(options.gains.begin(), options.gains.end());
      if (method != PatchMethod::gradient) {
        asked.split = options.split;
        asked.slower = options.slower;
      }
      PatchOptions patched;
      try {
        patched = judged_patch(mechanism, library, asked).options;
      } catch (const PatchError& error) {
        if (error.kind() == PatchError::Kind::request) throw;
        refuse(asked, {}, error);
        continue;
      }
      const std::size_t first = comparison.runs.size();
      for (const double gain : options.gains) {
        patched.gain = gain;
        try {
          comparison.runs.push_back(comparer.compared(patched));
        } catch (const SolveError& error) {
          refuse(asked, gain, error);
        }
      }
      if (comparison.runs.size() == first) continue;
      GainSeries series{method,
                        bandwidth.value_or(default_bandwidth(mechanism)),
                        first,
                        comparison.runs.size() - first,
                        comparer.floor(patched),
                        {}};
      series.order = fitted_order(comparison.runs_of(series), series.floor.value_or(0));
      comparison.series.push_back(series);
    }
  }
  if (comparison.runs.empty()) std::rethrow_exception(first_refusal);
  return comparison;
}

}  // namespace

bool stands_clear(double error, double floor) {
  constexpr double kAboveFloor = 10;
  return error >= kAboveFloor * floor;
}

Comparison compare(const Mechanism& mechanism, const BlockLibrary& library, const CompareOptions& options) {
  return compare_within_range(within_range(mechanism), library, options);
}

}  // namespace oblique
