// SPDX-License-Identifier: MIT
// A chain of servo amplifiers: the time per block and step must not depend on the length of the chain.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "diagrams.h"
#include "figures.h"

namespace oblique::bench {
namespace {

struct Chain {
  int blocks = 0;
  std::unique_ptr<CompiledDiagram> compiled;
  std::vector<double> times;  ///< per block and step [s], one a run
  long steps = 0;
  double rest = 0;  ///< [s]
};

void servo_chain(benchmark::State& state) {
  const BlockLibrary library = BlockLibrary::shipped();
  std::vector<Chain> chains;
  for (const int n : {10, 100, 1000, 10'000}) {
    const Diagram diagram = parse_diagram(servo_chain_text(n), "servo-chain");
    chains.push_back({n, std::make_unique<CompiledDiagram>(diagram, library), {}, 0, 0});
  }
  for (auto _ : state) {
    double total = 0;
    for (Chain& chain : chains) {
      // Short chains run more often: one of their runs is over before the neighbours of this processor
      // change.
      for (int repetition = 0; repetition < std::clamp(1000 / chain.blocks, 1, 50); ++repetition) {
        const TimedRun timed = timed_run(*chain.compiled);
        chain.steps = timed.run.statistics.steps;
        chain.rest = timed.rest;
        chain.times.push_back(timed.integration / static_cast<double>(chain.blocks * chain.steps));
        total += timed.rest + timed.integration;
      }
    }
    state.SetIterationTime(total);
  }

  double fastest = 1, slowest = 0;
  for (const Chain& chain : chains) {
    const double time = median(chain.times);
    fastest = std::min(fastest, time);
    slowest = std::max(slowest, time);
    const std::string n = std::to_string(chain.blocks);
    state.counters["ns_" + n] = 1e9 * time;
    state.counters["steps_" + n] = static_cast<double>(chain.steps);
    state.counters["rest_ms_" + n] = 1e3 * chain.rest;
  }
  // What a step costs besides its blocks, from t(n) = fixed/n + block at the two shortest chains.
  const double fixed =
      (median(chains[0].times) - median(chains[1].times)) / (1.0 / chains[0].blocks - 1.0 / chains[1].blocks);
  state.counters["fixed_us_per_step"] = 1e6 * fixed;
  state.counters["spread"] = slowest / fastest;
  record(
      {"servo chain: time per block and step, n = 10 ... 10000, largest/smallest", slowest / fastest, 2, ""});
}

BENCHMARK(servo_chain)->Name("servo_chain")->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(9);

}  // namespace
}  // namespace oblique::bench
