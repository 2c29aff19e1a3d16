// SPDX-License-Identifier: MIT
// Runs the benchmarks, then prints the figures that the project promises, each beside its bound.
#include <benchmark/benchmark.h>

#include "figures.h"
#include "heat_ladder_bench.h"

int main(int argc, char** argv) {
  if (const auto status = oblique::bench::heat_ladder_child(argc, argv)) return *status;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  oblique::bench::print_figures();
  return 0;
}
