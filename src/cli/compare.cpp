// SPDX-License-Identifier: MIT
#include <oblique/compare/compare.h>

#include <chrono>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include <oblique/compare/monte_carlo.h>
#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "comparison_output.h"
#include "monte_carlo_output.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& expected,
                         const std::string& remedy = {}) {
  throw ReadError(Diagnostic{{}, what, expected, remedy});
}

/// Positive finite numbers of an option that takes several.
std::vector<double> numbers_option(const std::string& option, const std::vector<std::string>& texts,
                                   std::string_view unit, const std::string& expected) {
  std::vector<double> values;
  for (const std::string& text : texts) {
    values.push_back(quantity_option(option, text, unit));
    if (!(values.back() > 0 && std::isfinite(values.back())))
      refuse(fmt::format("{} {}", option, text), expected);
  }
  return values;
}

CompareOptions options_of(const CompareRequest& request) {
  CompareOptions options;
  options.methods.clear();
  for (const std::string& method : request.methods) options.methods.push_back(method_option(method));
  if (!request.gains.empty())
    options.gains = numbers_option("--gain", request.gains, "1", "finite gains above 0, such as 1e3,1e4,1e5");
  options.bandwidths = numbers_option("--bandwidth", request.bandwidths, "Hz",
                                      "finite bandwidths above 0, such as 10,100 or \"1 kHz\"");
  return options;
}

/// The patch that a single comparison is of.
PatchOptions patch_options(const CompareRequest& request, const CompareOptions& options) {
  const auto one_of = [](const char* option, std::size_t n) {
    if (n > 1) refuse(fmt::format("--monte-carlo with {} of {}", count(n, "value", "values"), option), "one");
  };
  one_of("--gain", request.gains.size());
  one_of("--bandwidth", options.bandwidths.size());
  one_of("--method", options.methods.size());
  PatchOptions patch;
  patch.method = options.methods.front();
  if (!request.gains.empty()) patch.gain = options.gains.front();
  if (!options.bandwidths.empty()) patch.bandwidth = options.bandwidths.front();
  return patch;
}

/// How far the elements scatter, at most: a factor two is no tolerance any more.
double tolerance_option(const std::string& text) {
  constexpr double kMost = 0.5;
  if (text.empty()) {
    refuse("--monte-carlo without how far the elements scatter", "--tolerance, such as 0.1%");
  }
  const double tolerance = quantity_option("--tolerance", text, "1");
  if (!(tolerance > 0 && tolerance <= kMost))
    refuse(fmt::format("--tolerance {}", text), "a number above 0 and up to 50%");
  return tolerance;
}

MonteCarloReport draw_elements(const CompareRequest& request, const Mechanism& mechanism,
                               const BlockLibrary& library, const PatchOptions& options) {
  MonteCarloReport report;
  report.tolerance = request.tolerance;
  report.unit = mechanism.length_unit;
  report.options.scatters = scatters_of_tolerance(library, tolerance_option(request.tolerance));
  report.options.runs = request.runs;
  report.options.seed = request.seed;
  report.options.first_run = request.first_run;
  report.options.threads = request.threads > 0
                               ? request.threads
                               : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  Diagram diagram = patch(mechanism, options);
  diagram.file = mechanism.file;
  if (report.options.runs == 1) {
    const FlatDiagram flat = flatten(diagram, library);
    for (const Draw& drawn : draw(flat, report.options.scatters, {request.seed, request.first_run})) {
      const FlatBlock& block = flat.blocks[drawn.block];
      report.draws.emplace_back(block.path + "." + block.definition->parameters[drawn.parameter].name,
                                drawn.value);
    }
  }
  Progress progress("drawing elements");
  report.options.progress = [&](double fraction) { progress.show(fraction); };
  const auto begin = std::chrono::steady_clock::now();
  report.result = monte_carlo(mechanism, diagram, library, report.options);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

}  // namespace

ExitStatus compare_mechanism(const Session& session, const CompareRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".json");
  const BlockLibrary library = session.blocks();
  CompareOptions options = options_of(request);
  std::optional<PatchOptions> single;
  if (request.runs > 0) {
    single = patch_options(request, options);
    tolerance_option(request.tolerance);
    options.gains = {single->gain};
  }
  const Mechanism mechanism = read_mechanism(request.mechanism);
  Comparison comparison;
  {
    Progress progress("comparing");
    options.progress = [&](double fraction) { progress.show(fraction); };
    comparison = compare(mechanism, library, options);
  }
  std::string text = to_text(comparison);
  nlohmann::ordered_json json = to_json(comparison);
  bool failed = false;
  if (single) {
    const MonteCarloReport report = draw_elements(request, mechanism, library, *single);
    text += to_text(report);
    json["monte_carlo"] = to_json(report);
    failed = !report.result.worst_run;
  }
  print(request.json ? json.dump(2) + "\n" : text);
  if (!request.output.empty()) save(request.output, json.dump(2) + "\n");
  return failed ? ExitStatus::solver_failed : ExitStatus::done;
}

}  // namespace oblique::cli
