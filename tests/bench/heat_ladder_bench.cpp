// SPDX-License-Identifier: MIT
// Heat in a rod, cut into n nodes: the time must grow with n, not with a power of it, and 10 000 nodes must
// fit into 200 MB. Each length runs in a process of its own, which alone knows its peak of memory.
#include "heat_ladder_bench.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>

#include "diagrams.h"
#include "figures.h"

namespace oblique::bench {
namespace {

constexpr std::string_view kOption = "--heat-ladder=";

/// dT_i/dt = T_{i−1} − 2 T_i + T_{i+1}; the left end is held at 1, the right end at 0.
std::string heat_ladder_text(int n) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "format = \"oblique-diagram/1\"\n[run]\nuntil = 100\nsamples = 11\n[blocks]\n");
  fmt::format_to(out, "hot = {{ type = \"constant\" }}\n");
  for (int i = 1; i <= n; ++i) {
    const std::string left = i == 1 ? "hot" : fmt::format("T{}", i - 1);
    const std::string right = i == n ? "" : fmt::format(", \"T{}\"", i + 1);
    fmt::format_to(out, "T{} = {{ type = \"integrator\", in = [\"{}\", \"-2*T{}\"{}] }}\n", i, left, i,
                   right);
  }
  fmt::format_to(out, "[outputs]\nfirst = \"T1\"\nlast = \"T{}\"\n", n);
  return fmt::to_string(text);
}

struct Usage {
  double seconds = 0;    ///< CPU time of reading, compiling and running
  double megabytes = 0;  ///< peak
};

/// Runs a ladder of n nodes in a child.
Usage usage_of(int n) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    const std::string option = fmt::format("{}{}", kOption, n);
    execl("/proc/self/exe", "oblique_bench", option.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) != child || status != 0) throw std::runtime_error("the ladder failed");
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<double>(usage.ru_maxrss) / 1024};
}

void heat_ladder(benchmark::State& state) {
  std::vector<double> short_times, long_times;
  double megabytes = 0;
  for (auto _ : state) {
    const Usage of_thousand = usage_of(1000), of_ten_thousand = usage_of(10'000);
    short_times.push_back(of_thousand.seconds / 1000);
    long_times.push_back(of_ten_thousand.seconds / 10'000);
    megabytes = of_ten_thousand.megabytes;
    state.SetIterationTime(of_thousand.seconds + of_ten_thousand.seconds);
  }
  state.counters["us_per_node_1000"] = 1e6 * median(short_times);
  state.counters["us_per_node_10000"] = 1e6 * median(long_times);
  state.counters["MB_10000"] = megabytes;
  record({"heat ladder: time per node, n = 10000 over n = 1000", median(long_times) / median(short_times), 2,
          ""});
  record({"heat ladder: memory of 10000 nodes", megabytes, 200, "MB"});
}

BENCHMARK(heat_ladder)->Name("heat_ladder")->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace

std::optional<int> heat_ladder_child(int argc, char** argv) {
  const std::string_view option = argc == 2 ? argv[1] : "";
  if (!option.starts_with(kOption)) return std::nullopt;
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::Diagram diagram = diagram::parse_diagram(
      heat_ladder_text(std::atoi(option.substr(kOption.size()).data())), "heat-ladder");
  const CompiledDiagram compiled(diagram, library);
  const solve::Run result = solve::run(compiled.program, compiled.flat, compiled.options);
  // The rod has settled near its hot end: T1 is near 1.
  return result.trajectory.at(10, 1) > 0.9 ? 0 : 1;
}

}  // namespace oblique::bench
