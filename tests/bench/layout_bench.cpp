// SPDX-License-Identifier: MIT
// Block diagrams as pictures: how long a large one takes, and how many crossings and bends the shipped ones
// have, so that a change that makes them worse is seen.
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/draw/schematic/diagram_drawing.h>

#include "figures.h"

namespace oblique::bench {
namespace {

/// 1000 summers with one to three inputs each, from blocks a little before them, a tenth with feedback.
std::string large_diagram() {
  std::mt19937 random(3);
  const auto draw = [&](unsigned n) { return static_cast<int>(random() % n); };
  std::string text = "format = \"oblique-diagram/1\"\n[blocks]\nb0 = { type = \"sine-source\" }\n";
  for (int b = 1; b < 1000; ++b) {
    text += "b" + std::to_string(b) + " = { type = \"summer\", in = [";
    const int inputs = 1 + draw(3);
    for (int k = 0; k < inputs; ++k) text += "\"b" + std::to_string(std::max(0, b - 1 - draw(12))) + "\", ";
    if (draw(10) == 0) text += "\"0.3*b" + std::to_string(std::min(999, b + 1 + draw(5))) + "\"";
    text += "] }\n";
  }
  return text;
}

void draw_large_diagram(benchmark::State& state) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::Diagram diagram = diagram::parse_diagram(large_diagram(), "bench");
  std::vector<double> times;
  for (auto _ : state) {
    const double begin = cpu_seconds();
    benchmark::DoNotOptimize(draw::draw_diagram(diagram, library));
    times.push_back(cpu_seconds() - begin);
    state.SetIterationTime(times.back());
  }
  record({"draw a diagram of 1000 blocks", median(times), 2, "s"});
}

void shipped_diagrams(benchmark::State& state) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  draw::LayoutQuality all;
  for (auto _ : state) {
    all = {};
    for (const char* const folder : {"lessons", "historical"}) {
      const auto path = std::filesystem::path(OBLIQUE_SOURCE_DIR) / "diagrams" / folder;
      for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (entry.path().extension() != ".toml") continue;
        const draw::LayoutQuality one = draw::drawing_quality(diagram::read_diagram(entry.path()), library);
        all.crossings += one.crossings;
        all.bends += one.bends;
      }
    }
  }
  state.counters["crossings"] = static_cast<double>(all.crossings);
  state.counters["bends"] = static_cast<double>(all.bends);
  record({"crossings in the pictures of the shipped diagrams", static_cast<double>(all.crossings), 550, ""});
  record({"bends in the pictures of the shipped diagrams", static_cast<double>(all.bends), 1450, ""});
}

BENCHMARK(draw_large_diagram)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(shipped_diagrams)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace oblique::bench
