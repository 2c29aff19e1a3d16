// SPDX-License-Identifier: MIT
// Many four-bars whose elements scatter: from the command to the table, and what a machine costs beside its
// integration.
#include <chrono>
#include <cstdlib>

#include <benchmark/benchmark.h>

#include <oblique/compare/monte_carlo.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/patch/patch.h>

#include "figures.h"

namespace oblique::bench {
namespace {

constexpr const char* kFourBar = OBLIQUE_SOURCE_DIR "/diagrams/mechanisms/four-bar.toml";

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The whole command in two threads, by the wall clock: on an idle machine.
void command(benchmark::State& state) {
  const std::string line = std::string(OBLIQUE_PROGRAM) + " compare " + kFourBar +
                           " --monte-carlo 10000 --tolerance 0.1% --threads 2 > /dev/null 2> /dev/null";
  std::vector<double> seconds;
  for (auto _ : state) {
    const double before = wall_seconds();
    if (std::system(line.c_str()) != 0) state.SkipWithError("the command failed");
    seconds.push_back(wall_seconds() - before);
    state.SetIterationTime(seconds.back());
  }
  record({"Monte Carlo: 10 000 four-bars in two threads, command to table", median(seconds), 0.6, "s"});
}

/// What a machine costs beside its integration: drawing, what follows from it, coming to rest, measuring.
void beside_integration(benchmark::State& state) {
  constexpr int kRuns = 4096;
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(kFourBar);
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::Diagram diagram = patch::patch_triangles(mechanism);
  compare::MonteCarloOptions options;
  options.scatters = ensemble::scatters_of_tolerance(library, 1e-3);
  const auto whole = [&](int runs) {
    options.runs = runs;
    const double before = cpu_seconds();
    const compare::MonteCarlo result = compare::monte_carlo(mechanism, diagram, library, options);
    if (result.count.by_cvodes > 0) state.SkipWithError("not in lanes");
    return cpu_seconds() - before;
  };

  // The same machines, drawn beforehand; and once more with a run that ends almost where it begins (much
  // shorter, and what is as small as its tolerance says nothing: lanes would be refused).
  diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  std::vector<std::uint32_t> varied;
  std::vector<std::vector<double>> values;
  for (int k = 0; k < kRuns; ++k) {
    std::vector<double>& mine = values.emplace_back();
    for (const ensemble::Draw& draw :
         ensemble::draw(flat, options.scatters, {options.seed, static_cast<std::uint64_t>(k)})) {
      if (k == 0) varied.push_back(network::ParameterNumbers(flat).parameter(draw.block, draw.parameter));
      mine.push_back(draw.value);
    }
  }
  ensemble::apply_draws(ensemble::draw(flat, options.scatters, {options.seed, 0}), flat);
  const auto run_of = [&](double part, int rows) {
    ensemble::EnsembleOptions how;
    how.run = solve::options_of(diagram.run);
    how.run.tolerance = 1e-6;
    how.run.until *= part;
    how.run.samples = rows;
    const ensemble::Ensemble ensemble(flat, varied, how);
    const double before = cpu_seconds();
    const ensemble::EnsembleCount count = ensemble.run(
        0, kRuns,
        [&](std::uint64_t k, std::span<double> all) {
          std::copy(values[k].begin(), values[k].end(), all.begin());
        },
        [](const ensemble::MachineRun&) {});
    if (count.by_cvodes > 0) state.SkipWithError("not in lanes");
    return cpu_seconds() - before;
  };
  std::vector<double> ratios, integrations, besides;
  for (auto _ : state) {
    const double all = (whole(2 * kRuns) - whole(kRuns)) / kRuns;  // without what is done once
    const double integration = (run_of(1, options.positions) - run_of(1e-3, 2)) / kRuns;
    integrations.push_back(1e6 * integration);
    besides.push_back(1e6 * (all - integration));
    ratios.push_back((all - integration) / integration);
    state.SetIterationTime(all);
  }
  state.counters["integration_us"] = median(integrations);
  state.counters["beside_us"] = median(besides);
  record({"Monte Carlo: a four-bar's cost beside its integration, over that", median(ratios), 1, ""});
}

BENCHMARK(command)
    ->Name("monte_carlo_command")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(5);
BENCHMARK(beside_integration)
    ->Name("monte_carlo_beside_integration")
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond)
    ->Iterations(5);

}  // namespace
}  // namespace oblique::bench
