// SPDX-License-Identifier: MIT
#include <oblique/report/machine_comparison_report.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <oblique/report/comparison_report.h>
#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

using Json = nlohmann::ordered_json;

/// What each figure does; errors are in `unit`, "[mm]".
std::string figures_text(const compare::MachineComparison& machine, const std::string& unit,
                         const std::string& ideal) {
  Table table({"figure", "of each", "error it makes alone" + unit, "part of the largest" + unit});
  const auto add = [&](const std::string& figure, const std::string& block, double alone, double share) {
    table.add({figure, block, fmt::format("{:.3e}", alone), fmt::format("{:.3e}", share)});
  };
  add(ideal, "", machine.ideal_error, machine.ideal_share);
  for (const compare::FigureError& figure : machine.figures)
    add(figure.figure, figure.block, figure.alone, figure.share);
  return table.text(2);
}

/// What limits the comparison: elements that the machine has not, scatter, loops, overloads.
std::string limits_text(const compare::MachineComparison& machine, const text::Vocabulary& vocabulary) {
  std::string text;
  if (!machine.absent.empty())
    text += fmt::format("the machine has no {}: ideal ones here\n", fmt::join(machine.absent, ", no "));
  if (!machine.scatter.empty())
    text += fmt::format("not in this, since elements differ in it: {} ({} draws it)\n",
                        fmt::join(machine.scatter, "; "), vocabulary.setting({"monte-carlo"}));
  if (!machine.stable) text += "its servo loops are NOT stable everywhere\n";
  for (const compare::Overload& overload : machine.overloads)
    text += fmt::format("overload: {} reaches {:.6g} at t = {:.6g} s\n", overload.signal, overload.peak.value,
                        overload.peak.time);
  return text;
}

}  // namespace

std::string to_text(const compare::MachineComparison& machine, const compare::Comparison& comparison,
                    const text::Vocabulary& vocabulary) {
  const std::string& unit = comparison.unit;
  std::string text = fmt::format("\non {}, of as many elements as it takes\n\n", machine.machine);
  Table table(
      {"", fmt::format("max error [{}]", unit), "of the largest link", fmt::format("rms error [{}]", unit)});
  table.add({"against the exact motion", fmt::format("{:.3e}", machine.max_error),
             fmt::format("{:.3e}", machine.max_error / comparison.size),
             fmt::format("{:.3e}", machine.rms_error)});
  table.add({"against ideal elements", fmt::format("{:.3e}", machine.from_ideal),
             fmt::format("{:.3e}", machine.from_ideal / comparison.size), ""});
  text += table.text(1) + "\n" +
          figures_text(machine, fmt::format(" [{}]", unit), "the method, on ideal elements");
  text += fmt::format("\nworst at {}, {}; the method and each figure alone add up to {:.1f} % of it\n",
                      machine.worst.point, drive_text(comparison, machine.worst.drive),
                      100 * machine.explained());
  return text + limits_text(machine, vocabulary);
}

std::string to_text(const compare::MachineComparison& machine, const text::Vocabulary& vocabulary) {
  std::string text = fmt::format(
      "on {}, of as many elements as it takes\n\n"
      "largest error {:.3e}, root of the mean square {:.3e}, of the largest value of an output\n\n",
      machine.machine, machine.max_error, machine.rms_error);
  text += figures_text(machine, "", "the elements, ideal ones");
  text += fmt::format("\nworst: output {} at t = {:.6g} s; these alone add up to {:.1f} % of it\n",
                      machine.worst.point, machine.worst.time, 100 * machine.explained());
  return text + limits_text(machine, vocabulary);
}

Json to_json(const compare::MachineComparison& machine) {
  Json json{{"title", machine.machine},
            {"max_error", machine.max_error},
            {"rms_error", machine.rms_error},
            {"from_ideal", machine.from_ideal},
            {"ideal_error", machine.ideal_error},
            {"worst",
             {{"point", machine.worst.point}, {"time", machine.worst.time}, {"drive", machine.worst.drive}}},
            {"ideal_share", machine.ideal_share},
            {"explained", machine.explained()},
            {"stable", machine.stable},
            {"overloads", machine.overloads.size()},
            {"absent", machine.absent},
            {"scatter", machine.scatter}};
  json["figures"] = Json::array();
  for (const compare::FigureError& figure : machine.figures) {
    json["figures"].push_back({{"figure", figure.figure},
                               {"block", figure.block},
                               {"alone", figure.alone},
                               {"share", figure.share}});
  }
  return json;
}

}  // namespace oblique::report
