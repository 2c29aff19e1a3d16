// SPDX-License-Identifier: MIT
// Linkages, patched and run by the engine, against the same equations written by hand for the same solver.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/patch/patch.h>

#include "diagrams.h"
#include "figures.h"
#include "linkage_cases.h"

namespace oblique::bench {
namespace {

void linkage(benchmark::State& state, const LinkageCase& chosen) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(
      fmt::format("{}/diagrams/mechanisms/{}.toml", OBLIQUE_SOURCE_DIR, chosen.file));
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const double before = cpu_seconds();
  const diagram::Diagram diagram = patch::patch_triangles(mechanism);
  const double patched = cpu_seconds();
  CompiledDiagram compiled(diagram, library);
  const double compile_time = cpu_seconds() - patched;
  HandSettings settings;
  settings.gain = patch::PatchOptions{}.gain;
  settings.bandwidth = patch::default_bandwidth(mechanism);
  settings.crank_speed = chosen.crank_speed;
  settings.scale = chosen.metres;
  settings.until = diagram.run.until;
  settings.tolerance = diagram.run.tolerance;
  settings.absolute_tolerance = solve::kAbsoluteTolerance * diagram.run.tolerance;
  settings.samples = diagram.run.samples;
  // Both begin where ours comes to rest.
  std::vector<double> start;
  compiled.options.on_sample = [&](double, std::span<const double> states, std::span<const double>) {
    if (start.empty()) start.assign(states.begin(), states.end());
  };
  const solve::Run first = solve::run(compiled.program, compiled.flat, compiled.options);
  compiled.options.on_sample = nullptr;
  const auto by_hand_to = [&](double tolerance) {
    HandSettings with = settings;
    with.absolute_tolerance *= tolerance / with.tolerance;
    with.tolerance = tolerance;
    return run_by_hand(chosen.by_hand, with, start);
  };
  const HandRun truth = by_hand_to(settings.tolerance / 1000);
  const double our_error = largest_error(values_of(first.trajectory, chosen.points), truth.values);
  const auto error_by_hand = [&](const HandRun& hand) { return largest_error(hand.values, truth.values); };
  // The engine is calibrated to err less than a solver left to its tolerance. So that both err alike, the
  // hand-written code gets the coarsest tolerance at which it does no worse.
  double tolerance = settings.tolerance;
  const double same_tolerance_error = error_by_hand(by_hand_to(tolerance));
  while (error_by_hand(by_hand_to(tolerance)) > our_error && tolerance > settings.tolerance / 500)
    tolerance /= std::pow(10, 0.125);

  std::vector<double> ratios, same_tolerance_ratios, ours_times, hand_times, rest_times;
  TimedRun ours;
  HandRun by_hand;
  bool ours_first = false;
  for (auto _ : state) {
    ours_first = !ours_first;  // whoever comes second finds the processor warm
    if (ours_first) ours = timed_run(compiled);
    by_hand = by_hand_to(tolerance);
    const double same_tolerance = by_hand_to(settings.tolerance).seconds;
    if (!ours_first) ours = timed_run(compiled);
    state.SetIterationTime(ours.rest + ours.integration + by_hand.seconds);
    ratios.push_back(ours.integration / by_hand.seconds);
    same_tolerance_ratios.push_back(ours.integration / same_tolerance);
    ours_times.push_back(ours.integration);
    hand_times.push_back(by_hand.seconds);
    rest_times.push_back(ours.rest);
  }

  const double hand_error = error_by_hand(by_hand);
  const auto our_steps = static_cast<double>(ours.run.statistics.steps);
  const auto hand_steps = static_cast<double>(by_hand.steps);
  // The same equations: both within some hundred tolerances of the size.
  if (!(our_error <= 1e-7 * chosen.metres) || !(hand_error <= 1e-7 * chosen.metres)) {
    state.SkipWithError(fmt::format("errors of {:.2g} and, by hand, {:.2g}", our_error, hand_error).c_str());
    return;
  }
  state.counters["ours_ms"] = 1e3 * median(ours_times);
  state.counters["hand_ms"] = 1e3 * median(hand_times);
  state.counters["ratio"] = median(ratios);
  state.counters["ratio_per_step"] = median(ratios) * hand_steps / our_steps;
  state.counters["ratio_same_tolerance"] = median(same_tolerance_ratios);
  state.counters["rest_ms"] = 1e3 * median(rest_times);
  state.counters["patch_ms"] = 1e3 * (patched - before);
  state.counters["compile_ms"] = 1e3 * compile_time;
  state.counters["steps_ours"] = our_steps;
  state.counters["steps_hand"] = hand_steps;
  state.counters["error_ours"] = our_error / chosen.metres;
  state.counters["error_hand"] = hand_error / chosen.metres;
  state.counters["error_hand_same_tolerance"] = same_tolerance_error / chosen.metres;
  record({chosen.title + ": integration and sampling, ours over hand-written of equal error", median(ratios),
          1.15, ""});
}

const bool kRegistered = [] {
  for (const LinkageCase& chosen : {four_bar(), six_bar(), jansen(), class_three()}) {
    benchmark::RegisterBenchmark(("linkage_" + chosen.file).c_str(),
                                 [chosen](benchmark::State& state) { linkage(state, chosen); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->MinTime(2);
  }
  return true;
}();

}  // namespace
}  // namespace oblique::bench
