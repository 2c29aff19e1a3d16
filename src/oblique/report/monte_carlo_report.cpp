// SPDX-License-Identifier: MIT
#include <oblique/report/monte_carlo_report.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPercents[] = {5, 25, 50, 75, 95, 100};

/// The edges of the bands that hold 95 % and half of the runs, and the median.
constexpr double kPercentsAlong[] = {2.5, 25, 50, 75, 97.5};

std::string percentiles(const MonteCarloReport& report) {
  Table table({"of the runs", fmt::format("largest error up to [{}]", report.unit)});
  for (const double percent : kPercents) {
    if (const auto error = report.result.percentile(percent))
      table.add({fmt::format("{:.0f} %", percent), fmt::format("{:.3e}", *error)});
  }
  return table.text();
}

/// How many failed, and the first of them; the others are in the JSON.
std::string failures(const compare::MonteCarlo& result) {
  if (result.failures.empty()) return {};
  const compare::FailedRun& first = result.failures.front();
  return fmt::format("FAILED {} of {}, left out above; the first, run {}: {}\n", result.failures.size(),
                     count(result.errors.size(), "run", "runs"), first.number, first.message);
}

std::string yield_text(const MonteCarloReport& report) {
  if (!report.result.yield) return {};
  const compare::Yield& yield = *report.result.yield;
  const double bound = *report.options.good_below;
  const std::string part =
      report.size > 0 ? fmt::format(" ({:.3g} % of the largest link)", 100 * bound / report.size) : "";
  std::string text = fmt::format(
      "yield: {} of {} err by less than {:.4g} {}{}: {:.2f} %, of all machines between {:.2f} and {:.2f} % "
      "with 95 % confidence\n",
      yield.good, count(yield.machines, "machine", "machines"), bound, report.unit, part, 100 * yield.part(),
      100 * yield.low, 100 * yield.high);
  const auto& within = report.options.until_within;
  if (within && (yield.high - yield.low) / 2 > *within)
    text += fmt::format("not known within ±{:.3g} % after these; more of them would tell\n", 100 * *within);
  return text;
}

std::string what_scatters(const MonteCarloReport& report) {
  return report.machine.empty() ? fmt::format("within ±{}", report.tolerance)
                                : fmt::format("as those of {} scatter", report.machine);
}

}  // namespace

std::string to_text(const MonteCarloReport& report, const text::Vocabulary& vocabulary) {
  const compare::MonteCarlo& result = report.result;
  std::string text =
      fmt::format("\nMonte Carlo: {}, {} drawn in each, uniform {}; seed {}, from run {}; {:.3g} s\n\n",
                  count(result.errors.size(), "run", "runs"), count(result.drawn, "tolerance", "tolerances"),
                  what_scatters(report), report.options.seed, report.options.first_run, report.seconds);
  if (result.errors.size() > 1) text += percentiles(report) + "\n";
  if (result.worst_run && result.errors.size() > 1) {
    const auto setting = [&](const char* name, std::uint64_t value) {
      return vocabulary.setting({name, std::to_string(value)});
    };
    text += fmt::format("worst: run {}, which {} {} {} repeats and lists\n", *result.worst_run,
                        setting("monte-carlo", 1), setting("first-run", *result.worst_run),
                        setting("seed", report.options.seed));
  }
  if (result.errors.size() == 1 && result.errors.front()) {
    Table table({"drawn", "value"});
    for (const auto& [name, value] : report.draws) table.add({name, fmt::format("{:.6g}", value)});
    text += table.text(1);
    text += fmt::format("\nlargest error with these {:.3e} {}\n", *result.errors.front(), report.unit);
  }
  return text + yield_text(report) + failures(result);
}

Json to_json(const MonteCarloReport& report, bool timings) {
  const compare::MonteCarlo& result = report.result;
  Json json{{"seed", report.options.seed},
            {"first_run", report.options.first_run},
            {"runs", result.errors.size()},
            {"drawn", result.drawn},
            {"seconds", timings ? Json(report.seconds) : Json(nullptr)}};
  json["percentiles"] = Json::object();
  for (const double percent : kPercents) {
    const auto error = result.percentile(percent);
    json["percentiles"][fmt::format("{:.0f}", percent)] = error ? Json(*error) : Json(nullptr);
  }
  json["along"] = {{"drive", result.drive}};
  for (const double percent : kPercentsAlong)
    json["along"][fmt::format("{}", percent)] = result.percentile_along(percent);
  if (result.yield) {
    json["yield"] = {{"below", *report.options.good_below},
                     {"good", result.yield->good},
                     {"machines", result.yield->machines},
                     {"part", result.yield->part()},
                     {"low", result.yield->low},
                     {"high", result.yield->high}};
  }
  json["worst_run"] = result.worst_run ? Json(*result.worst_run) : Json(nullptr);
  json["errors"] = Json::array();
  for (const auto& error : result.errors) json["errors"].push_back(error ? Json(*error) : Json(nullptr));
  json["failures"] = Json::array();
  for (const compare::FailedRun& run : result.failures)
    json["failures"].push_back({{"run", run.number}, {"message", run.message}});
  if (result.errors.size() == 1) {
    json["draws"] = Json::object();
    for (const auto& [name, value] : report.draws) json["draws"][name] = value;
  }
  return json;
}

}  // namespace oblique::report
