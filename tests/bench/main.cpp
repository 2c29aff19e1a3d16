// SPDX-License-Identifier: MIT
// Runs the benchmarks, then prints the figures that the project promises, each beside its bound.
#include <benchmark/benchmark.h>

#include "figures.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  oblique::bench::print_figures();
  return 0;
}
