// SPDX-License-Identifier: MIT
#include <oblique/compare/compare.h>

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

std::string to_json(const Comparison& comparison) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const GainRun& run : comparison.runs) {
    runs.push_back({{"gain", run.gain},
                    {"max_error", run.max_error},
                    {"rms_error", run.rms_error},
                    {"steps", run.steps},
                    {"seconds", run.seconds},
                    {"overloads", run.overloads.size()},
                    {"stable", run.stable}});
  }
  nlohmann::ordered_json json{{"mechanism", comparison.mechanism},
                              {"method", method_name(comparison.method)},
                              {"size", comparison.size}};
  json["runs"] = std::move(runs);
  json["order"] =
      comparison.order ? nlohmann::ordered_json(*comparison.order) : nlohmann::ordered_json(nullptr);
  return json.dump(2) + "\n";
}

std::string to_table(const Comparison& comparison) {
  const std::string& unit = comparison.unit;
  std::string text = fmt::format(
      "{}\nanalog: {} of {:.6g} Hz; exact: closed form; errors over all moving points and one turn\n\n",
      comparison.mechanism,
      comparison.method == PatchMethod::gradient ? "gradient servos, bandwidth"
                                                 : "servo-tracked triangles, amplifiers",
      comparison.bandwidth);
  Table table({"gain", fmt::format("max error [{}]", unit), "of the largest link",
               fmt::format("rms error [{}]", unit), "worst point", "steps", "ms", "overloads", "stable"});
  for (const GainRun& run : comparison.runs) {
    table.add({short_number(run.gain), fmt::format("{:.3e}", run.max_error),
               fmt::format("{:.3e}", run.max_error / comparison.size), fmt::format("{:.3e}", run.rms_error),
               run.worst_point, std::to_string(run.steps), fmt::format("{:.3g}", 1e3 * run.seconds),
               std::to_string(run.overloads.size()), run.stable ? "yes" : "NO"});
  }
  text += table.text();
  text += fmt::format(
      "\nlargest link {:.6g} {}; amplifiers of gain 1e12 leave {:.0e} {} (the solver's tolerance)\n",
      comparison.size, unit, comparison.floor, unit);
  text += comparison.order
              ? fmt::format("the error falls with the gain to the power {:.3f}\n", *comparison.order)
              : std::string("no order: it takes two gains whose errors stand clear of the tolerance\n");
  for (const GainRun& run : comparison.runs) {
    for (const Overload& overload : run.overloads) {
      text += fmt::format("overload at gain {:.6g}: {} reaches {:.6g} at t = {:.6g} s\n", run.gain,
                          overload.signal, overload.peak.value, overload.peak.time);
    }
  }
  return text;
}

}  // namespace

ExitStatus compare_mechanism(const Session& session, const CompareRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".json");
  const BlockLibrary library = session.blocks();
  CompareOptions options;
  options.method = method_option(request.method);
  options.gains.clear();
  for (const std::string& gain : request.gains) {
    options.gains.push_back(quantity_option("--gain", gain, "1"));
    if (!(options.gains.back() > 0 && std::isfinite(options.gains.back()))) {
      throw ReadError(
          Diagnostic{{}, fmt::format("--gain {}", gain), "finite gains above 0, such as 1e3,1e4,1e5", {}});
    }
  }
  const Mechanism mechanism = read_mechanism(request.mechanism);
  Comparison comparison;
  {
    Progress progress("comparing");
    options.progress = [&](double fraction) { progress.show(fraction); };
    comparison = compare(mechanism, library, options);
  }
  print(request.json ? to_json(comparison) : to_table(comparison));
  if (!request.output.empty()) save(request.output, to_json(comparison));
  return ExitStatus::done;
}

}  // namespace oblique::cli
