// SPDX-License-Identifier: MIT
// Rodas5P beside CVODES in one run, at equal error: linkages, a relaxation oscillation, what switches often.
#include <algorithm>
#include <cmath>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/patch/patch.h>

#include "diagrams.h"
#include "figures.h"

namespace oblique::bench {
namespace {

struct Case {
  std::string file, title;
  double tolerance;  ///< of the run by Rodas5P
  double bound;      ///< of its time over that of CVODES
  double truth;      ///< tolerance of the run that both are held against, by CVODES
};

diagram::Diagram diagram_of(const Case& chosen) {
  const std::string path = fmt::format("{}/{}", OBLIQUE_SOURCE_DIR, chosen.file);
  if (chosen.file.find("mechanisms/") == std::string::npos) return diagram::read_diagram(path);
  return patch::patch_triangles(mechanism::read_mechanism(path));
}

/// The largest error of any column beside its size.
double largest_error(const solve::Trajectory& rows, const solve::Trajectory& truth) {
  double largest = 0;
  for (std::size_t column = 1; column < truth.columns().size(); ++column) {
    double error = 0, size = 0;
    for (std::size_t row = 0; row < truth.rows(); ++row) {
      error = std::max(error, std::abs(rows.at(row, column) - truth.at(row, column)));
      size = std::max(size, std::abs(truth.at(row, column)));
    }
    if (size > 0) largest = std::max(largest, error / size);
  }
  return largest;
}

void rodas(benchmark::State& state, const Case& chosen) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  CompiledDiagram ours(diagram_of(chosen), library);
  ours.options.samples = 72;  // so that rows are no large part of the time
  ours.options.absolute_tolerance.reset();
  CompiledDiagram theirs = ours;
  ours.options.method = diagram::IntegrationMethod::rodas;
  ours.options.tolerance = chosen.tolerance;
  const auto by_cvodes = [&](double tolerance) {
    theirs.options.tolerance = tolerance;
    return timed_run(theirs);
  };
  const solve::Trajectory truth = by_cvodes(chosen.truth).run.trajectory;
  const TimedRun first = timed_run(ours);
  const double error = largest_error(first.run.trajectory, truth);
  // The other gets the coarsest tolerance at which it does no worse.
  double tolerance = 1e-2;
  TimedRun other = by_cvodes(tolerance);
  while (largest_error(other.run.trajectory, truth) > error && tolerance > 100 * chosen.truth) {
    tolerance /= std::pow(10, 0.125);
    other = by_cvodes(tolerance);
  }
  std::vector<double> ratios, times;
  bool first_ours = false;
  for (auto _ : state) {
    first_ours = !first_ours;  // whoever comes second finds the processor warm
    double our_time = 0;
    if (first_ours) our_time = timed_run(ours).integration;
    const double other_time = by_cvodes(tolerance).integration;
    if (!first_ours) our_time = timed_run(ours).integration;
    state.SetIterationTime(our_time + other_time);
    ratios.push_back(our_time / other_time);
    times.push_back(our_time);
  }
  state.counters["ms"] = 1e3 * median(times);
  state.counters["ratio"] = median(ratios);
  state.counters["error"] = error;
  state.counters["error_cvodes"] = largest_error(other.run.trajectory, truth);
  state.counters["steps"] = static_cast<double>(first.run.statistics.steps);
  state.counters["steps_cvodes"] = static_cast<double>(other.run.statistics.steps);
  state.counters["evaluations"] = static_cast<double>(first.run.statistics.evaluations);
  state.counters["evaluations_cvodes"] = static_cast<double>(other.run.statistics.evaluations);
  record({fmt::format("{}, error {:.0e}: Rodas5P over CVODES", chosen.title, error), median(ratios),
          chosen.bound, ""});
}

const bool kRodasRegistered = [] {
  const std::string linkages = "diagrams/mechanisms/";
  const Case cases[] = {
      {linkages + "four-bar.toml", "four-bar", 1e-4, 0.9, 1e-12},
      {linkages + "four-bar.toml", "four-bar", 1e-7, 1.5, 1e-12},
      {linkages + "class-iii.toml", "class III", 1e-4, 0.9, 1e-12},
      {linkages + "class-iii.toml", "class III", 1e-7, 1.5, 1e-12},
      {linkages + "jansen.toml", "Jansen, both legs", 1e-4, 1.1, 1e-12},
      {linkages + "jansen.toml", "Jansen, both legs", 1e-7, 2, 1e-12},
      {"tests/diagrams/literature/van_der_pol_1000.toml", "van der Pol, 1000", 1e-4, 0.5, 1e-12},
      {"tests/diagrams/literature/van_der_pol_1000.toml", "van der Pol, 1000", 1e-7, 0.7, 1e-12},
      {"diagrams/lessons/backlash-servo.toml", "servo with backlash, 98 events", 1e-8, 0.4, 1e-12},
      {"diagrams/historical/time-division-multiplier.toml", "time-division multiplier, 1900 events", 1e-8,
       0.9, 1e-12},
  };
  for (const Case& chosen : cases) {
    const std::string name = chosen.file.substr(chosen.file.rfind('/') + 1);
    benchmark::RegisterBenchmark(fmt::format("rodas_{}_{:.0e}", name, chosen.tolerance).c_str(),
                                 [chosen](benchmark::State& state) { rodas(state, chosen); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->MinTime(0.5);
  }
  return true;
}();

}  // namespace
}  // namespace oblique::bench
