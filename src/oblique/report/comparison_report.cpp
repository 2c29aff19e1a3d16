// SPDX-License-Identifier: MIT
#include <oblique/report/comparison_report.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

using Json = nlohmann::ordered_json;

bool has_one(const compare::Comparison& comparison) {
  return comparison.series.size() == 1;
}

/// What was compared with what: "triangles", "triangles,gradient".
std::string methods_of(const compare::Comparison& comparison) {
  std::string text;
  std::string_view last;
  for (const compare::GainSeries& series : comparison.series) {
    const std::string_view name = patch::method_name(series.method);
    if (name != last) text += fmt::format("{}{}", text.empty() ? "" : ",", name);
    last = name;
  }
  return text;
}

Json json_of(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const compare::ComparedRun& run, bool timings) {
  Json json{{"gain", run.gain},
            {"max_error", run.max_error},
            {"rms_error", run.rms_error},
            {"steps", run.steps},
            {"seconds", timings ? Json(run.seconds) : Json(nullptr)},
            {"overloads", run.overloads.size()},
            {"stable", run.stable},
            {"method", patch::method_name(run.method)},
            {"bandwidth", run.bandwidth},
            {"left_branch", json_of(run.left_branch)}};
  json["worst"] = {{"point", run.worst.point},
                   {"time", run.worst.time},
                   {"drive", run.worst.drive},
                   {"reason", run.worst.reason.empty() ? Json(nullptr) : Json(run.worst.reason)}};
  json["parts"] = nullptr;
  if (run.parts)
    json["parts"] = {{"static", run.parts->at_rest}, {"lag", run.parts->lag}, {"solver", run.parts->solver}};
  return json;
}

std::string_view analog_of(patch::PatchMethod method) {
  return method == patch::PatchMethod::gradient ? "gradient servos, bandwidth"
                                                : "servo-tracked triangles, amplifiers";
}

/// The first columns of a row: method and bandwidth where there are several, then the gain.
class RowHead {
 public:
  explicit RowHead(const compare::Comparison& comparison) {
    for (const compare::GainSeries& series : comparison.series) {
      methods_ = methods_ || series.method != comparison.series.front().method;
      bandwidths_ = bandwidths_ || series.bandwidth != comparison.series.front().bandwidth;
    }
  }

  std::vector<std::string> series_titles() const {
    std::vector<std::string> cells;
    if (methods_) cells.emplace_back("method");
    if (bandwidths_) cells.emplace_back("Hz");
    return cells;
  }

  std::vector<std::string> titles() const {
    std::vector<std::string> cells = series_titles();
    cells.emplace_back("gain");
    return cells;
  }

  std::vector<std::string> cells(const compare::GainSeries& series) const {
    std::vector<std::string> cells;
    if (methods_) cells.emplace_back(patch::method_name(series.method));
    if (bandwidths_) cells.push_back(short_number(series.bandwidth));
    return cells;
  }

  std::vector<std::string> cells(const compare::ComparedRun& run) const {
    std::vector<std::string> cells =
        this->cells(compare::GainSeries{run.method, run.bandwidth, 0, 0, {}, {}});
    cells.push_back(short_number(run.gain));
    return cells;
  }

  /// "gain 1000", with what else tells the run from the others.
  std::string run_name(const compare::ComparedRun& run) const {
    std::string text = fmt::format("gain {:.6g}", run.gain);
    if (bandwidths_) text += fmt::format(", {:.6g} Hz", run.bandwidth);
    if (methods_) text += fmt::format(", {}", patch::method_name(run.method));
    return text;
  }

  bool has_several_bandwidths() const { return bandwidths_; }

 private:
  bool methods_ = false, bandwidths_ = false;
};

std::vector<std::string> joined(std::vector<std::string> head, std::vector<std::string> rest) {
  head.insert(head.end(), rest.begin(), rest.end());
  return head;
}

std::string error_table(const compare::Comparison& comparison, const RowHead& head) {
  const std::string& unit = comparison.unit;
  Table table(joined(head.titles(), {fmt::format("max error [{}]", unit), "of the largest link",
                                     fmt::format("rms error [{}]", unit), "worst point", "steps", "ms",
                                     "overloads", "stable"}));
  for (const compare::ComparedRun& run : comparison.runs) {
    table.add(
        joined(head.cells(run),
               {fmt::format("{:.3e}", run.max_error), fmt::format("{:.3e}", run.max_error / comparison.size),
                fmt::format("{:.3e}", run.rms_error), run.worst.point, std::to_string(run.steps),
                fmt::format("{:.3g}", 1e3 * run.seconds), std::to_string(run.overloads.size()),
                run.left_branch ? "other mode"
                : run.stable    ? "yes"
                                : "NO"}));
  }
  return table.text();
}

std::string parts_table(const compare::Comparison& comparison, const RowHead& head) {
  const std::string& unit = comparison.unit;
  Table table(joined(head.titles(), {"worst at", "drive", fmt::format("static [{}]", unit),
                                     fmt::format("lag [{}]", unit), fmt::format("solver [{}]", unit)}));
  for (const compare::ComparedRun& run : comparison.runs) {
    const auto part = [&](double compare::ErrorParts::*which) {
      return run.parts ? fmt::format("{:.3e}", *run.parts.*which) : std::string("unknown");
    };
    table.add(joined(head.cells(run), {run.worst.point, drive_text(comparison, run.worst.drive),
                                       part(&compare::ErrorParts::at_rest), part(&compare::ErrorParts::lag),
                                       part(&compare::ErrorParts::solver)}));
  }
  return table.text();
}

/// Each reason once, with the place in the first run that has it.
std::string reasons_of(const compare::Comparison& comparison) {
  std::string text;
  std::vector<std::string_view> told;
  for (const compare::ComparedRun& run : comparison.runs) {
    const compare::WorstPlace& worst = run.worst;
    if (worst.reason.empty() || std::find(told.begin(), told.end(), worst.reason) != told.end()) continue;
    told.emplace_back(worst.reason);
    text +=
        fmt::format("worst at {}, {}: {}\n", worst.point, drive_text(comparison, worst.drive), worst.reason);
  }
  return text;
}

/// Floor and order: sentences of one series, a table of several.
std::string orders_of(const compare::Comparison& comparison, const RowHead& head) {
  const std::string& unit = comparison.unit;
  if (has_one(comparison)) {
    const compare::GainSeries& series = comparison.series.front();
    const std::string floor =
        series.floor ? fmt::format("leave {:.0e} {} (the solver's tolerance)", *series.floor, unit)
                     : "do not run, so what the tolerance leaves is unknown";
    return fmt::format("largest link {:.6g} {}; amplifiers of gain 1e12 {}\n", comparison.size, unit, floor) +
           (series.order ? fmt::format("the error falls with the gain to the power {:.3f}\n", *series.order)
                         : "no order: it takes two gains whose errors stand clear of the tolerance\n");
  }
  Table table(
      joined(head.series_titles(), {"power of the gain", fmt::format("left at gain 1e12 [{}]", unit)}));
  for (const compare::GainSeries& series : comparison.series) {
    table.add(joined(head.cells(series), {series.order ? fmt::format("{:.3f}", *series.order) : "none",
                                          series.floor ? fmt::format("{:.0e}", *series.floor) : "unknown"}));
  }
  return fmt::format(
      "largest link {:.6g} {}; how the error goes with the gain, and what the tolerance leaves\n\n{}",
      comparison.size, unit, table.text());
}

std::string drive_text(bool turning, const std::string& unit, double value) {
  if (!turning) return fmt::format("{:.4g} {}", value, unit);
  const double degrees = std::fmod(value * 180 / std::numbers::pi, 360);
  return fmt::format("{:.4g}°", degrees < 0 ? degrees + 360 : degrees);
}

}  // namespace

std::string drive_text(const compare::Comparison& comparison, double value) {
  return drive_text(comparison.turning, comparison.unit, value);
}

std::string left_branch_text(const mechanism::Mechanism& mechanism, double drive,
                             const text::Vocabulary& vocabulary) {
  const mechanism::Drive& first = mechanism.drives.front();
  return fmt::format(
      "warning: its run goes over into another assembly mode, from {} = {} on, and its points are not the "
      "mechanism's then: it passes too near a dead centre; {} tells how other methods and gains do\n",
      first.name, drive_text(!first.slide, mechanism.length_unit, drive),
      vocabulary.action(text::Action{"compare"}));
}

nlohmann::ordered_json to_json(const compare::Comparison& comparison, bool timings) {
  Json json{{"mechanism", comparison.mechanism},
            {"method", methods_of(comparison)},
            {"size", comparison.size},
            {"runs", Json::array()}};
  for (const compare::ComparedRun& run : comparison.runs) json["runs"].push_back(json_of(run, timings));
  json["order"] = has_one(comparison) ? json_of(comparison.series.front().order) : Json(nullptr);
  json["unit"] = comparison.unit;
  json["series"] = Json::array();
  for (const compare::GainSeries& series : comparison.series) {
    json["series"].push_back({{"method", patch::method_name(series.method)},
                              {"bandwidth", series.bandwidth},
                              {"floor", json_of(series.floor)},
                              {"order", json_of(series.order)}});
  }
  json["refused"] = Json::array();
  for (const compare::RefusedRun& run : comparison.refused) {
    json["refused"].push_back({{"method", patch::method_name(run.method)},
                               {"bandwidth", json_of(run.bandwidth)},
                               {"gain", json_of(run.gain)},
                               {"why", run.why.what}});
  }
  return json;
}

std::string to_text(const compare::Comparison& comparison) {
  const RowHead head(comparison);
  const compare::GainSeries& first = comparison.series.front();
  std::string text = comparison.mechanism + "\nanalog: ";
  std::string_view last;
  for (const compare::GainSeries& series : comparison.series) {
    const std::string_view name = analog_of(series.method);
    if (name == last) continue;
    text += fmt::format("{}{}{}", last.empty() ? "" : "; ", name,
                        head.has_several_bandwidths() ? "" : fmt::format(" of {:.6g} Hz", first.bandwidth));
    last = name;
  }
  text += comparison.closed_form ? "; exact: closed form" : "; exact: closed form and Newton's method";
  text += "; errors over all moving points and the whole motion\n\n";
  text += error_table(comparison, head);
  text +=
      "\nthe largest error and its parts: static, of loops at rest; lag, of their speed; solver, of its "
      "tolerance\n\n";
  text += parts_table(comparison, head) + "\n" + reasons_of(comparison);
  text += orders_of(comparison, head);
  for (const compare::ComparedRun& run : comparison.runs) {
    if (!run.left_branch) continue;
    text += fmt::format(
        "wrong branch at {}: its loops hold another assembly mode from {} on; that is no error of the gain, "
        "and not in its order\n",
        head.run_name(run), drive_text(comparison, *run.left_branch));
  }
  for (const compare::ComparedRun& run : comparison.runs) {
    for (const compare::Overload& overload : run.overloads) {
      text += fmt::format("overload at {}: {} reaches {:.6g} at t = {:.6g} s\n", head.run_name(run),
                          overload.signal, overload.peak.value, overload.peak.time);
    }
  }
  return text;
}

}  // namespace oblique::report
