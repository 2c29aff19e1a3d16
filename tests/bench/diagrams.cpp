// SPDX-License-Identifier: MIT
#include "diagrams.h"

#include <iterator>

#include <fmt/format.h>

#include "figures.h"

namespace oblique::bench {
namespace {

constexpr std::string_view kHead = R"(format = "oblique-diagram/1"
[run]
until     = "20*pi"
tolerance = 1e-8
samples   = 101
[blocks]
one = { type = "constant" }
)";

}  // namespace

std::string servo_chain_text(int n) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}phi = {{ type = \"integrator\", in = [\"one\"] }}\n", kHead);
  fmt::format_to(out, "s0 = {{ type = \"cosine\", in = \"phi\" }}\n");
  for (int k = 1; k <= n; ++k) {
    fmt::format_to(out,
                   "s{} = {{ type = \"servo-amplifier\", in = [\"s{}\", \"-s{}\"], gain = 1e6, bandwidth = "
                   "\"20 Hz\", initial = 1 }}\n",
                   k, k, k - 1);
  }
  fmt::format_to(out, "[outputs]\nfirst = \"s1\"\nlast = \"s{}\"\n", n);
  return fmt::to_string(text);
}

std::string dyad_row_text(int n) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}zero = {{ type = \"constant\", value = 0 }}\n", kHead);
  fmt::format_to(out, "crank = {{ type = \"crank-generator\" }}\n");
  for (int k = 1; k <= n; ++k) {
    fmt::format_to(
        out,
        "d{0} = {{ type = \"dyad-rrr\", px = \"0.25*crank.cos\", py = \"0.25*crank.sin\", qx = \"one\", "
        "qy = \"zero\", r1 = {1:.6f}, r2 = 0.75, reach = 1.25, bandwidth = \"20 Hz\" }}\n",
        k, 0.8 + 0.1 * k / n);
  }
  fmt::format_to(out, "[outputs]\nx = \"d1.x\"\ny = \"d{}.y\"\n", n);
  return fmt::to_string(text);
}

TimedRun timed_run(const CompiledDiagram& diagram) {
  TimedRun timed;
  solve::RunOptions options = diagram.options;
  // The first row of the grid is taken when the loops have come to rest and nothing has been integrated.
  bool started = false;
  double start = 0;
  options.on_sample = [&](double, std::span<const double>, std::span<const double>) {
    if (!started) start = cpu_seconds();
    started = true;
  };
  const double begin = cpu_seconds();
  timed.run = solve::run(diagram.program, diagram.flat, options);
  timed.integration = cpu_seconds() - start;
  timed.rest = start - begin;
  return timed;
}

}  // namespace oblique::bench
