// SPDX-License-Identifier: MIT
// A chain of servo amplifiers: what a block adds to a step must not depend on the length of the chain.
#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <oblique/diagram/diagram_reader.h>

#include "diagrams.h"
#include "figures.h"

namespace oblique::bench {
namespace {

struct Chain {
  int blocks = 0;
  std::unique_ptr<CompiledDiagram> compiled;
  std::vector<double> times;  ///< per step [s], one a run
  long steps = 0;
  double rest = 0;  ///< [s]
};

constexpr int kShortest[] = {1, 4};  // from which the fixed cost of a step is told
constexpr int kLengths[] = {10, 100, 1000, 10'000, 100'000};

void servo_chain(benchmark::State& state) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  std::vector<Chain> chains;
  const auto add = [&](int n) {
    const diagram::Diagram diagram = diagram::parse_diagram(servo_chain_text(n), "servo-chain");
    chains.push_back({n, std::make_unique<CompiledDiagram>(diagram, library), {}, 0, 0});
  };
  for (const int n : kShortest) add(n);
  for (const int n : kLengths) add(n);
  int round = 0;
  for (auto _ : state) {
    double total = 0;
    for (Chain& chain : chains) {
      if (round > 0 && chain.blocks > 10'000) continue;  // ten seconds each
      // Short chains run more often: one of their runs is over before the neighbours of this processor
      // change.
      for (int repetition = 0; repetition < std::clamp(1000 / chain.blocks, 1, 50); ++repetition) {
        const TimedRun timed = timed_run(*chain.compiled);
        chain.steps = timed.run.statistics.steps;
        chain.rest = timed.rest;
        chain.times.push_back(timed.integration / static_cast<double>(chain.steps));
        total += timed.rest + timed.integration;
      }
    }
    ++round;
    state.SetIterationTime(total);
  }

  // A step costs fixed + n · block, most of the first CVODES' own: from the two shortest chains.
  const double one = median(chains[0].times), four = median(chains[1].times);
  const double fixed = one - (four - one) / (kShortest[1] - kShortest[0]) * kShortest[0];
  double fastest = 1, slowest = 0;
  for (std::size_t k = std::size(kShortest); k < chains.size(); ++k) {
    const Chain& chain = chains[k];
    const double time = (median(chain.times) - fixed) / chain.blocks;
    fastest = std::min(fastest, time);
    slowest = std::max(slowest, time);
    const std::string n = std::to_string(chain.blocks);
    state.counters["ns_" + n] = 1e9 * time;
    state.counters["steps_" + n] = static_cast<double>(chain.steps);
    state.counters["rest_ms_" + n] = 1e3 * chain.rest;
  }
  state.counters["fixed_us_per_step"] = 1e6 * fixed;
  state.counters["spread"] = slowest / fastest;
  record({"servo chain: a block's part of a step, n = 10 ... 100000, largest/smallest", slowest / fastest, 2,
          ""});
  record({"servo chain: what a step costs besides its blocks", 1e6 * fixed, 1.5, "us"});
}

BENCHMARK(servo_chain)->Name("servo_chain")->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(9);

}  // namespace
}  // namespace oblique::bench
