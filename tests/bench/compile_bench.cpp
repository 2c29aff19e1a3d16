// SPDX-License-Identifier: MIT
// From the text of a diagram of 10 000 primitive blocks to its Program, part by part.
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include "diagrams.h"
#include "figures.h"

namespace oblique::bench {
namespace {

void compile(benchmark::State& state, const std::string& text, const std::string& what) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  std::vector<double> parse_times, flatten_times, assemble_times, program_times, totals;
  std::size_t blocks = 0, instructions = 0;
  for (auto _ : state) {
    const double begin = cpu_seconds();
    const diagram::Diagram diagram = diagram::parse_diagram(text, "bench");
    const double parsed = cpu_seconds();
    const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
    const double flattened = cpu_seconds();
    network::Network network = network::assemble(flat);
    const double assembled = cpu_seconds();
    const network::Program program(std::move(network));
    const double compiled = cpu_seconds();
    state.SetIterationTime(compiled - begin);
    parse_times.push_back(parsed - begin);
    flatten_times.push_back(flattened - parsed);
    assemble_times.push_back(assembled - flattened);
    program_times.push_back(compiled - assembled);
    totals.push_back(compiled - begin);
    blocks = flat.blocks.size();
    instructions = program.n_instructions();
  }
  state.counters["parse_ms"] = 1e3 * median(parse_times);
  state.counters["flatten_ms"] = 1e3 * median(flatten_times);
  state.counters["assemble_ms"] = 1e3 * median(assemble_times);
  state.counters["program_ms"] = 1e3 * median(program_times);
  state.counters["blocks"] = static_cast<double>(blocks);
  state.counters["instructions"] = static_cast<double>(instructions);
  record({"compile 10 000 blocks: " + what, median(totals), 1, "s"});
}

constexpr int kBlocks = 10'000;
constexpr int kBlocksPerDyad = 23;

void compile_chain(benchmark::State& state) {
  compile(state, servo_chain_text(kBlocks), "a chain of servo amplifiers");
}

void compile_dyads(benchmark::State& state) {
  compile(state, dyad_row_text(kBlocks / kBlocksPerDyad), "dyads, which are composite");
}

BENCHMARK(compile_chain)
    ->Name("compile_chain")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(9);
BENCHMARK(compile_dyads)
    ->Name("compile_dyads")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(9);

}  // namespace
}  // namespace oblique::bench
