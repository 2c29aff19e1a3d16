// SPDX-License-Identifier: MIT
// A pot of a patched four-bar that is turned while it runs: with other numbers in the same equations, and
// where the equations are others and compiled anew, the state carried over.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <oblique/oblique.h>
#include "figures.h"

namespace oblique::bench {
namespace {

/// A patched four-bar on its way, and the gain of one of its amplifiers.
struct Held {
  diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  console::Console machine{patch::patch_triangles(mechanism::read_mechanism(
                               std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml")),
                           library};
  std::string pot;

  Held() {
    machine.advance(0.1);
    for (const std::string& name : machine.pot_names()) {
      if (name.ends_with(".gain")) pot = name;
    }
  }
};

/// The time that `turn` takes, and until the machine can be read again.
void turn_a_pot(benchmark::State& state, const std::vector<std::string>& values, console::Turned how,
                const std::string& what, double asked, const std::string& unit, double scale) {
  Held held;
  held.machine.turn(held.pot, values.back());
  std::vector<double> turns, wholes;
  std::size_t k = 0;
  for (auto _ : state) {
    const std::string& value = values[k++ % values.size()];
    const double begin = cpu_seconds();
    const console::Turned turned = held.machine.turn(held.pot, value);
    const double middle = cpu_seconds();
    held.machine.value(held.pot);
    benchmark::DoNotOptimize(held.machine.signal(held.machine.signal_names().front()));
    wholes.push_back(cpu_seconds() - begin);
    turns.push_back(middle - begin);
    if (turned != how) state.SkipWithError("turned otherwise");
    state.SetIterationTime(wholes.back());
  }
  record({"a pot of a four-bar turned, " + what, scale * median(turns), asked, unit});
  record({what + ", until the machine is read again", 1e3 * median(wholes), 2, "ms"});
}

void turn_at_once(benchmark::State& state) {
  turn_a_pot(state, {"2e4", "1e4"}, console::Turned::at_once, "without compilation", 2, "us", 1e6);
}
BENCHMARK(turn_at_once)->Name("console/turn")->UseManualTime()->Iterations(2000);

void turn_and_compile(benchmark::State& state) {
  turn_a_pot(state, {"inf", "1e4"}, console::Turned::compiled_anew, "compiled anew", 2, "ms", 1e3);
}
BENCHMARK(turn_and_compile)->Name("console/turn and compile")->UseManualTime()->Iterations(200);

}  // namespace
}  // namespace oblique::bench
