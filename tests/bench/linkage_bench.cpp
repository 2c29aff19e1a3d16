// SPDX-License-Identifier: MIT
// Linkages, patched and run by the engine, against the same equations written by hand for the same solver.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/patch/patch.h>

#include "diagrams.h"
#include "figures.h"
#include "linkage_by_hand.h"

namespace oblique::bench {
namespace {

struct Case {
  std::string file, title;
  HandLinkage by_hand;
  std::vector<std::string> points;  ///< names of those that are shown
  double crank_speed, metres;       ///< [rad/s]; of a machine unit, in the unit of the file
};

HandLinkage::Step dyad(HandLinkage::Dyad made) {
  return {made, std::nullopt};
}
HandLinkage::Step carried(HandLinkage::Carried made) {
  return {std::nullopt, made};
}

/// Points: 0 B, 1 D, 2 C, 3 M.
Case four_bar() {
  HandLinkage made;
  made.crank = 1.0 / 4;
  made.fixed = {{1, 1, 0}};
  made.steps = {dyad({2, 0, 1, 3.5 / 4, 3.0 / 4, 1, 1.25}), carried({3, 0, 2, 1.75 / 3.5, 1 / 3.5})};
  made.shown = {0, 2, 3};
  return {"four-bar", "four-bar", made, {"B", "C", "M"}, 1, 4};
}

/// Points: 0 B, 1 D, 2 C, 3 E, 4 F.
Case six_bar() {
  HandLinkage made;
  made.crank = 0.4;
  made.fixed = {{1, 1, 0}};
  made.steps = {dyad({2, 0, 1, 0.7, 0.75, 1, 1.4}), carried({3, 0, 2, 50.0 / 140, 0}),
                carried({4, 0, 2, 50.0 / 140, 45.0 / 140})};
  made.shown = {0, 2, 3, 4};
  return {"six-bar-above", "six-bar", made, {"B", "C", "E", "F"}, 100, 200};
}

/// Points: P1 … P6 are 0 … 5, Q1 … Q6 are 6 … 11, and O2 is 12; 1 machine unit is 200 mm.
Case jansen() {
  HandLinkage made;
  made.crank = 15.0 / 200;
  made.mirror = 6;
  made.fixed = {{12, -38.0 / 200, -7.8 / 200}};
  const double unit = 200, wide = 0.269, long_one = 0.361;
  const auto corner = [](double base, double from, double to) {  // left of the base, from its first end
    const double along = (base * base + from * from - to * to) / (2 * base);
    return std::array{along / base, std::sqrt(from * from - along * along) / base};
  };
  const auto upper = corner(41.5, 40.1, 55.8), lower = corner(36.7, 49, 65.7);
  for (const std::size_t leg : {0UL, 6UL}) {
    made.steps.push_back(dyad({leg + 1, leg, 12, 50 / unit, 41.5 / unit, -1, wide}));
    made.steps.push_back(carried({leg + 2, 12, leg + 1, upper[0], upper[1]}));
    made.steps.push_back(dyad({leg + 5, leg, 12, 61.9 / unit, 39.3 / unit, 1, wide}));
    made.steps.push_back(dyad({leg + 3, leg + 2, leg + 5, 39.4 / unit, 36.7 / unit, -1, long_one}));
    made.steps.push_back(carried({leg + 4, leg + 5, leg + 3, lower[0], lower[1]}));
  }
  made.shown = {0, 6, 1, 2, 5, 3, 4, 7, 8, 11, 9, 10};
  return {"jansen",
          "Jansen, both legs",
          made,
          {"P1", "Q1", "P2", "P3", "P6", "P4", "P5", "Q2", "Q3", "Q6", "Q4", "Q5"},
          2 * std::numbers::pi,
          unit};
}

/// Points: 0 A, 1 E, 2 O1, 3 B, 4 C, 5 D; the distance E–B is found by the loop that closes E–D.
Case class_three() {
  HandLinkage made;
  made.crank = 0.15;
  made.fixed = {{1, 0.73, 0.412}, {2, 0, 0.6}};
  made.steps = {dyad({3, 0, 1, 0.535, 0, -1, 0.989, true}),
                dyad({4, 3, 2, 0.5045260151865313, 0.9725, -1, 1.08}),
                carried({5, 3, 4, 0.5388259119650045, 0.37946406648686987})};
  made.loop = HandLinkage::Loop{5, 0.73, 0.412, 0.3785, 100};
  made.shown = {0, 3, 5, 4};
  return {"class-iii", "class III", made, {"A", "B", "D", "C"}, 1, 2};
}

/// The largest error of a run in any column, against a finer one; [the file's unit].
double largest_error(const std::vector<double>& values, const std::vector<double>& finer) {
  double largest = values.size() == finer.size() ? 0 : INFINITY;
  for (std::size_t k = 0; k < std::min(values.size(), finer.size()); ++k)
    largest = std::max(largest, std::abs(values[k] - finer[k]));
  return largest;
}

std::vector<double> values_of(const solve::Trajectory& ours, const std::vector<std::string>& points) {
  std::vector<std::size_t> columns{0};
  for (const std::string& point : points) {
    columns.push_back(ours.find(point + ".x").value());
    columns.push_back(ours.find(point + ".y").value());
  }
  std::vector<double> values;
  for (std::size_t row = 0; row < ours.rows(); ++row) {
    for (const std::size_t column : columns) values.push_back(ours.at(row, column));
  }
  return values;
}

void linkage(benchmark::State& state, const Case& chosen) {
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
  for (const Case& chosen : {four_bar(), six_bar(), jansen(), class_three()}) {
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
