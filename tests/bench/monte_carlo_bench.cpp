// SPDX-License-Identifier: MIT
// Many four-bars whose elements scatter: what a run costs from the draw to the largest error.
#include <benchmark/benchmark.h>

#include <oblique/compare/monte_carlo.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/patch/patch.h>

#include "figures.h"

namespace oblique::bench {
namespace {

void monte_carlo_four_bar(benchmark::State& state) {
  constexpr int kRuns = 1000, kPromised = 10'000, kThreads = 2;
  const mechanism::Mechanism mechanism =
      mechanism::read_mechanism(OBLIQUE_SOURCE_DIR "/diagrams/mechanisms/four-bar.toml");
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::Diagram diagram = patch::patch_triangles(mechanism);
  compare::MonteCarloOptions options;
  options.scatters = ensemble::scatters_of_tolerance(library, 1e-3);
  options.runs = kRuns;
  std::vector<double> seconds;
  for (auto _ : state) {
    const double before = cpu_seconds();
    const compare::MonteCarlo result = compare::monte_carlo(mechanism, diagram, library, options);
    seconds.push_back(cpu_seconds() - before);
    state.SetIterationTime(seconds.back());
    if (!result.failures.empty()) state.SkipWithError(result.failures.front().message.c_str());
    options.first_run += kRuns;
  }
  state.counters["runs_per_second_and_thread"] = kRuns / median(seconds);
  record({"Monte Carlo: 10 000 four-bars in two threads", median(seconds) * kPromised / kRuns / kThreads, 10,
          "s"});
}

BENCHMARK(monte_carlo_four_bar)
    ->Name("monte_carlo")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);

}  // namespace
}  // namespace oblique::bench
