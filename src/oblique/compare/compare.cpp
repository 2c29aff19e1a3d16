// SPDX-License-Identifier: MIT
#include <oblique/compare/compare.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>

#include <fmt/format.h>

#include <oblique/commission/judge.h>
#include <oblique/compare/branch.h>
#include <oblique/compare/error_parts.h>
#include <oblique/compare/patched_run.h>
#include <oblique/compare/worst_reason.h>
#include <oblique/ensemble/engine/work_queue.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/solve/solve_error.h>

namespace oblique::compare {
namespace {

/// Amplifiers of this gain err by far less than what the tolerance of any run leaves. Ideal ones would not do
/// for the floor: without the dynamics of the loops there are fewer errors to add up, ten times fewer in a
/// Jansen leg.
constexpr double kFloorGain = 1e12;
/// Nobody asked for the floor: a run that takes a hundred times the steps of one with an ordinary gain tells
/// none.
constexpr std::int64_t kMostFloorSteps = 200'000;

/// The runs of one method and one bandwidth, and what came out of each.
struct AskedSeries {
  patch::PatchOptions asked;    ///< of the highest gain
  patch::PatchOptions patched;  ///< as they were judged
  std::exception_ptr refusal;   ///< a patch::PatchError, where there is no patch and so no run
  struct Outcome {
    std::optional<ComparedRun> run;
    std::exception_ptr failure;  ///< a solve::SolveError, where there is no run
  };
  std::vector<Outcome> outcomes;  ///< a gain each
  std::optional<double> floor;
};

/// The runs of a comparison, in any order and from any thread.
class Comparer {
 public:
  Comparer(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
           const CompareOptions& options, const mechanism::Structure& structure,
           const mechanism::Motion& exact, const WorstReasons& reasons)
      : mechanism_(mechanism),
        library_(library),
        options_(options),
        structure_(structure),
        exact_(exact),
        reasons_(reasons) {}

  /// Has all runs of the series done: of each gain, and at last the floor.
  void run(std::vector<AskedSeries>& series) {
    const std::size_t n_gains = options_.gains.size(), of_series = n_gains + 1;
    for (AskedSeries& each : series) {
      each.outcomes.resize(n_gains);
      if (!each.refusal) total_ += static_cast<double>(2 * n_gains + 1);
    }
    ensemble::work_off(0, series.size() * of_series, options_.threads,
                       [&](const ensemble::Next& next) {
                         for (std::uint64_t number = 0; next(number);) {
                           AskedSeries& of = series[number / of_series];
                           if (of.refusal) continue;
                           const std::size_t gain = number % of_series;
                           if (gain == n_gains) {
                             of.floor = floor(of.patched);
                           } else {
                             of.outcomes[gain] = outcome(of.patched, options_.gains[gain]);
                           }
                         }
                       },
                       {});
  }

 private:
  AskedSeries::Outcome outcome(patch::PatchOptions options, double gain) {
    options.gain = gain;
    try {
      return {compared(options), {}};
    } catch (const solve::SolveError&) {
      return {{}, std::current_exception()};
    }
  }

  ComparedRun compared(const patch::PatchOptions& options) {
    const PatchedMechanism patched(patch_named(mechanism_, options), library_);
    const RecordedRun recorded = run_recorded(patched, name_of(options), options.tolerance, progress());
    finish_run();
    const solve::Run& analog = recorded.run;
    ComparedRun result;
    result.method = options.method;
    result.gain = options.gain;
    result.bandwidth = options.bandwidth.value_or(patch::default_bandwidth(mechanism_));
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

  std::optional<double> floor(patch::PatchOptions options) {
    options.gain = kFloorGain;
    try {
      const PatchedMechanism patched(patch_named(mechanism_, options), library_);
      const RecordedRun recorded =
          run_recorded(patched, name_of(options), options.tolerance, progress(), {}, kMostFloorSteps);
      finish_run();
      return distances(mechanism_, patched.flat, recorded.run.trajectory, exact_).largest;
    } catch (const solve::SolveError&) {  // nobody asked for this run
      finish_run();
      return std::nullopt;
    }
  }

  /// "amplifiers of gain 1000 and 20 Hz, method gradient": bandwidth and method where there was a choice.
  std::string name_of(const patch::PatchOptions& options) const {
    std::string name = fmt::format("amplifiers of gain {:.6g}", options.gain);
    if (options.bandwidth) name += fmt::format(" and {:.6g} Hz", *options.bandwidth);
    if (options_.methods.size() > 1) name += fmt::format(", method {}", patch::method_name(options.method));
    return name;
  }

  void finish_run() {
    ++done_;
    if (options_.progress) progress()(0);
  }

  /// Tells nothing from other threads than the one that asked for the comparison.
  std::function<void(double)> progress() const {
    if (!options_.progress) return {};
    return [this](double fraction) {
      if (std::this_thread::get_id() == asker_) options_.progress((done_ + fraction) / total_);
    };
  }

  const mechanism::Mechanism& mechanism_;
  const diagram::BlockLibrary& library_;
  const CompareOptions& options_;
  const mechanism::Structure& structure_;
  const mechanism::Motion& exact_;
  const WorstReasons& reasons_;
  const std::thread::id asker_ = std::this_thread::get_id();
  double total_ = 0;  ///< runs
  std::atomic<int> done_ = 0;
};

Comparison compare_within_range(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                                const CompareOptions& options) {
  Comparison comparison;
  comparison.mechanism = mechanism.title;
  comparison.unit = mechanism.length_unit;
  comparison.size = mechanism.largest_length();
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  comparison.closed_form = std::none_of(
      structure.groups.begin(), structure.groups.end(),
      [](const mechanism::Group& group) { return group.form.kind == mechanism::GroupKind::general; });
  comparison.turning = mechanism.drives.empty() || !mechanism.drives.front().slide;
  const int rows = mechanism::rows_over_motion(mechanism, options.positions);
  const mechanism::Motion exact = mechanism::solve_motion(mechanism, rows);
  for (const auto& drives : exact.drives) comparison.drive.push_back(drives.front().value);
  const WorstReasons reasons(mechanism, exact);
  std::vector<std::optional<double>> bandwidths(options.bandwidths.begin(), options.bandwidths.end());
  if (bandwidths.empty()) bandwidths.emplace_back();
  std::exception_ptr first_refusal;
  const auto refuse = [&](const patch::PatchOptions& asked, std::optional<double> gain,
                          const std::exception_ptr& why) {
    if (!first_refusal) first_refusal = why;
    try {
      std::rethrow_exception(why);
    } catch (const text::Error& error) {
      comparison.refused.push_back({asked.method, asked.bandwidth, gain, error.diagnostics().front()});
    }
  };
  std::vector<AskedSeries> all;
  for (const patch::PatchMethod method : options.methods) {
    for (const std::optional<double>& bandwidth : bandwidths) {
      patch::PatchOptions asked;
      asked.method = method;
      asked.bandwidth = bandwidth;
      asked.samples = rows;
      asked.gain = *std::max_element(options.gains.begin(), options.gains.end());
      if (method != patch::PatchMethod::gradient) {
        asked.split = options.split;
        asked.slower = options.slower;
      }
      AskedSeries& of = all.emplace_back();
      of.asked = asked;
      try {
        of.patched = commission::judged_patch(mechanism, library, asked).options;
      } catch (const patch::PatchError& error) {
        if (error.kind() == patch::PatchError::Kind::request) throw;
        of.refusal = std::current_exception();
      }
    }
  }
  Comparer(mechanism, library, options, structure, exact, reasons).run(all);
  for (AskedSeries& of : all) {
    if (of.refusal) {
      refuse(of.asked, {}, of.refusal);
      continue;
    }
    const std::size_t first = comparison.runs.size();
    for (std::size_t g = 0; g < options.gains.size(); ++g) {
      AskedSeries::Outcome& outcome = of.outcomes[g];
      if (outcome.run) {
        comparison.runs.push_back(std::move(*outcome.run));
        continue;
      }
      refuse(of.asked, options.gains[g], outcome.failure);
    }
    if (comparison.runs.size() == first) continue;
    GainSeries series{of.asked.method, of.asked.bandwidth.value_or(patch::default_bandwidth(mechanism)),
                      first,           comparison.runs.size() - first,
                      of.floor,        {}};
    series.order = fitted_order(comparison.runs_of(series), series.floor.value_or(0));
    comparison.series.push_back(series);
  }
  if (comparison.runs.empty()) std::rethrow_exception(first_refusal);
  return comparison;
}

}  // namespace

bool stands_clear(double error, double floor) {
  constexpr double kAboveFloor = 10;
  return error >= kAboveFloor * floor;
}

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

Comparison compare(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                   const CompareOptions& options) {
  return compare_within_range(patch::within_range(mechanism), library, options);
}

}  // namespace oblique::compare
