// SPDX-License-Identifier: MIT
// The four-bar, patched and run by the engine, against the same equations written by hand for the same
// solver.
#include <algorithm>
#include <cmath>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <oblique/mechanism/read_mechanism.h>
#include <oblique/patch/patch.h>

#include "diagrams.h"
#include "figures.h"
#include "four_bar_by_hand.h"

namespace oblique::bench {
namespace {

/// Largest difference of the two trajectories in any column [m].
double largest_difference(const Trajectory& ours, const FourBarRun& by_hand) {
  if (ours.rows() != by_hand.rows.size() || ours.columns().size() != by_hand.rows.front().size())
    return INFINITY;
  double largest = 0;
  for (std::size_t row = 0; row < ours.rows(); ++row) {
    for (std::size_t column = 0; column < by_hand.rows[row].size(); ++column) {
      largest = std::max(largest, std::abs(ours.at(row, column) - by_hand.rows[row][column]));
    }
  }
  return largest;
}

void four_bar(benchmark::State& state) {
  const Mechanism mechanism = read_mechanism(OBLIQUE_SOURCE_DIR "/diagrams/mechanisms/four-bar.toml");
  const BlockLibrary library = BlockLibrary::shipped();
  const double before = cpu_seconds();
  const Diagram diagram = patch_triangles(mechanism);
  const double patched = cpu_seconds();
  const CompiledDiagram compiled(diagram, library);
  const double compile_time = cpu_seconds() - patched;
  const FourBarSettings settings{PatchOptions{}.gain,
                                 default_bandwidth(mechanism),
                                 diagram.run.until,
                                 diagram.run.tolerance,
                                 kAbsoluteTolerance * diagram.run.tolerance,
                                 diagram.run.samples};

  std::vector<double> ratios, whole_ratios, ours_times, hand_times, rest_times;
  TimedRun ours;
  FourBarRun by_hand;
  bool ours_first = false;
  for (auto _ : state) {
    ours_first = !ours_first;  // whoever comes second finds the processor warm
    if (ours_first) ours = timed_run(compiled);
    by_hand = run_four_bar_by_hand(settings);
    if (!ours_first) ours = timed_run(compiled);
    state.SetIterationTime(ours.rest + ours.integration + by_hand.seconds);
    ratios.push_back(ours.integration / by_hand.seconds);
    whole_ratios.push_back((ours.rest + ours.integration) / by_hand.seconds);
    ours_times.push_back(ours.integration);
    hand_times.push_back(by_hand.seconds);
    rest_times.push_back(ours.rest);
  }

  const double difference = largest_difference(ours.run.trajectory, by_hand);
  const auto our_steps = static_cast<double>(ours.run.statistics.steps);
  const auto hand_steps = static_cast<double>(by_hand.steps);
  // At rest the residuals are rounding, taken 1e7 times: last digits steer the choice of steps.
  constexpr double kStepSlack = 0.15;
  if (!(difference <= 1e-8)) {
    state.SkipWithError(fmt::format("the trajectories differ by {} m", difference).c_str());
    return;
  }
  if (std::abs(our_steps / hand_steps - 1) > kStepSlack) {
    state.SkipWithError(fmt::format("{} steps against {} by hand", our_steps, hand_steps).c_str());
    return;
  }
  state.counters["ours_ms"] = 1e3 * median(ours_times);
  state.counters["hand_ms"] = 1e3 * median(hand_times);
  state.counters["ratio"] = median(ratios);
  state.counters["ratio_per_step"] = median(ratios) * hand_steps / our_steps;
  state.counters["rest_ms"] = 1e3 * median(rest_times);
  state.counters["ratio_with_rest"] = median(whole_ratios);
  state.counters["patch_ms"] = 1e3 * (patched - before);
  state.counters["compile_ms"] = 1e3 * compile_time;
  state.counters["steps_ours"] = our_steps;
  state.counters["steps_hand"] = hand_steps;
  state.counters["difference_m"] = difference;
  record({"four-bar: integration and sampling, ours over hand-written", median(ratios), 1.15, ""});
  record({"four-bar: the same per step", median(ratios) * hand_steps / our_steps, 1.25, ""});
}

BENCHMARK(four_bar)->Name("four_bar")->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(2);

}  // namespace
}  // namespace oblique::bench
