// SPDX-License-Identifier: MIT
// A pot of a patched four-bar that is turned while it runs: the diagram compiled anew, the state carried
// over.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <oblique/oblique.h>
#include "figures.h"

namespace oblique::bench {
namespace {

void turn_a_pot(benchmark::State& state) {
  const std::string folder = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/";
  const auto mechanism = mechanism::read_mechanism(folder + "four-bar.toml");
  const auto library = diagram::BlockLibrary::shipped();
  console::Console machine(patch::patch_triangles(mechanism), library);
  machine.advance(0.1);
  std::string pot;
  for (const std::string& name : machine.pot_names()) {
    if (name.ends_with(".gain")) pot = name;
  }
  std::vector<double> times;
  int k = 0;
  for (auto _ : state) {
    const double begin = cpu_seconds();
    machine.turn(pot, k++ % 2 == 0 ? "2e4" : "1e4");
    times.push_back(cpu_seconds() - begin);
    state.SetIterationTime(times.back());
  }
  record({"a pot of a four-bar turned, compiled anew", 1e3 * median(times), 2, "ms"});
}
BENCHMARK(turn_a_pot)->Name("console/turn")->UseManualTime()->Iterations(200);

}  // namespace
}  // namespace oblique::bench
