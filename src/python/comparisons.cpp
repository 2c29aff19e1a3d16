// SPDX-License-Identifier: MIT
#include "binding.h"

#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

#include <oblique/commission/on_machine.h>
#include <oblique/compare/budget.h>
#include <oblique/compare/compare.h>
#include <oblique/compare/machine_comparison.h>
#include <oblique/compare/monte_carlo.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/draw/chart/chart.h>
#include <oblique/report/budget_report.h>
#include <oblique/report/comparison_chart.h>
#include <oblique/report/comparison_report.h>
#include <oblique/report/json_text.h>
#include <oblique/report/judgement_text.h>
#include <oblique/report/machine_comparison_report.h>
#include <oblique/report/monte_carlo_report.h>

namespace oblique::python {
namespace {

/// How the elements scatter: within a tolerance, or as those of a machine.
std::vector<diagram::BlockFigure> scatters_of(const Library& library, const diagram::MachineProfile* machine,
                                              std::optional<double> tolerance) {
  if (tolerance) return ensemble::scatters_of_tolerance(*library, *tolerance);
  if (machine != nullptr && !machine->scatters.empty()) return machine->scatters;
  throw text::ReadError(text::Diagnostic{
      {},
      machine == nullptr ? std::string("nothing says how far the elements scatter")
                         : "nothing is published of how the elements of " + machine->title + " scatter",
      "a tolerance, such as 0.001",
      text::Remedy{"give ", text::Setting{"tolerance"}, machine == nullptr ? " or " : "",
                   machine == nullptr ? text::Remedy::Piece(text::Setting{"machine"}) : std::string()}});
}

/// Whose tolerances the errors come from.
report::BudgetReport budget_of(const mechanism::Mechanism& mechanism, const diagram::Diagram& diagram,
                               const Library& library, const diagram::MachineProfile* machine,
                               std::optional<double> tolerance, bool turning) {
  report::BudgetReport report;
  report.unit = mechanism.length_unit;
  report.turning = turning;
  compare::BudgetOptions options;
  options.scatters = scatters_of(library, machine, tolerance);
  report.scatter = tolerance ? "within ±" + nlohmann::json(*tolerance).dump()
                             : "as those of " + machine->title + " scatter";
  unlocked([&](SignalWatch& watch) {
    options.progress = watch.progress();
    report.budget = compare::error_budget(mechanism, diagram, *library, options);
    return 0;
  });
  return report;
}

int threads_of(const py::dict& asked) {
  const int threads = entry(asked, "threads", 0);
  return threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// How the elements are to be drawn: what is set of `tolerance`, `runs`, `seed`, `first_run`, `threads`,
/// `good_below` (a part of the largest link where `of_the_largest`), `until_within`.
report::MonteCarloReport draw_elements(const mechanism::Mechanism& mechanism, const diagram::Diagram& diagram,
                                       const Library& library, const diagram::MachineProfile* machine,
                                       const py::dict& asked) {
  report::MonteCarloReport report;
  report.unit = mechanism.length_unit;
  const auto tolerance = entry<std::optional<double>>(asked, "tolerance", std::nullopt);
  report.options.scatters = scatters_of(library, machine, tolerance);
  if (tolerance) {
    report.tolerance = nlohmann::json(*tolerance).dump();
  } else {
    report.machine = machine->title;
  }
  report.options.runs = entry(asked, "runs", 1000);
  report.options.seed = entry<std::uint64_t>(asked, "seed", 1);
  report.options.first_run = entry<std::uint64_t>(asked, "first_run", 0);
  report.size = mechanism.largest_length();
  report.options.good_below = entry<std::optional<double>>(asked, "good_below", std::nullopt);
  if (report.options.good_below && entry(asked, "of_the_largest", false))
    *report.options.good_below *= report.size;
  report.options.until_within = entry<std::optional<double>>(asked, "until_within", std::nullopt);
  report.options.threads = threads_of(asked);
  unlocked([&](SignalWatch& watch) {
    report.options.progress = watch.progress();
    report.result = compare::monte_carlo(mechanism, diagram, *library, report.options);
    return 0;
  });
  report.options.progress = nullptr;
  return report;
}

/// The draws of `monte_carlo`, if it is no None, are of the single gain and bandwidth that there are then.
py::dict compared(const MechanismModel& model, const Library& library, const py::dict& asked,
                  const std::string& machine_name, const py::object& monte_carlo) {
  compare::CompareOptions options;
  options.gains = entry(asked, "gains", options.gains);
  options.bandwidths = entry(asked, "bandwidths", options.bandwidths);
  options.split = entry(asked, "split", options.split);
  options.slower = entry(asked, "slower", options.slower);
  options.positions = entry(asked, "positions", options.positions);
  options.threads = threads_of(asked);
  options.methods.clear();
  for (const std::string& name : entry(asked, "methods", std::vector<std::string>{"triangles"}))
    options.methods.push_back(patch_method(name));
  const diagram::MachineProfile* const machine =
      machine_name.empty() ? nullptr : diagram::find_machine(machine_name);
  if (machine == nullptr && !machine_name.empty())
    throw diagram::DiagramError(diagram::unknown_machine(machine_name));
  const bool draws = !monte_carlo.is_none(), with_budget = entry(asked, "budget", false);
  const auto tolerance = entry<std::optional<double>>(asked, "tolerance", std::nullopt);
  if (with_budget) scatters_of(library, machine, tolerance);  // before the work, not after it

  mechanism::Mechanism mechanism;
  diagram::Diagram drawn;  // whose elements scatter
  patch::PatchOptions single;
  std::string bandwidth_text;
  compare::Comparison comparison;
  std::optional<compare::MachineComparison> on_machine;
  unlocked([&](SignalWatch& watch) {
    mechanism = patch::within_range(model.mechanism);
    if (machine != nullptr || draws || with_budget) {
      single.method = options.methods.front();
      single.split = options.split;
      single.slower = options.slower;
      single.gain = options.gains.front();
      if (!options.bandwidths.empty()) single.bandwidth = options.bandwidths.front();
      commission::JudgedPatch patched = commission::judged_patch(mechanism, *library, single);
      single = patched.options;
      drawn = patched.diagram;
      if (machine != nullptr) {
        const commission::MachinePatch on_elements =
            commission::put_on_machine(mechanism, *library, *machine, std::move(patched));
        single = on_elements.options;
        drawn = on_elements.realised;
        if (single.bandwidth) options.bandwidths = {*single.bandwidth};
        bandwidth_text = report::bandwidth_text(on_elements, *machine);
      }
    }
    options.progress = watch.progress();
    comparison = compare::compare(mechanism, *library, options);
    if (machine != nullptr)
      on_machine = compare::compare_on_machine(mechanism, *library, *machine, single, watch.progress());
    return 0;
  });
  nlohmann::ordered_json json = report::to_json(comparison, true);
  std::string text = report::to_text(comparison);
  draw::Chart chart = report::chart_of(comparison);
  if (on_machine) {
    text += report::to_text(*on_machine, comparison, python_words()) + bandwidth_text;
    json["machine"] = report::to_json(*on_machine);
  }
  if (with_budget) {
    const report::BudgetReport budget =
        budget_of(mechanism, drawn, library, machine, tolerance, comparison.turning);
    text += report::to_text(budget);
    json["budget"] = report::to_json(budget);
  }
  if (draws) {
    const report::MonteCarloReport drawn_report =
        draw_elements(mechanism, drawn, library, machine, monte_carlo.cast<py::dict>());
    text += report::to_text(drawn_report, python_words());
    json["monte_carlo"] = report::to_json(drawn_report, false);
    for (draw::Panel& panel : report::panels_of(comparison, drawn_report))
      chart.panels.push_back(std::move(panel));
  }
  py::list along, overloads;
  for (compare::ComparedRun& run : comparison.runs) {
    along.append(to_array(std::move(run.error_along)));
    py::list signals;
    for (const compare::Overload& overload : run.overloads)
      signals.append(py::make_tuple(to_str(overload.signal), overload.peak.value, overload.peak.time));
    overloads.append(signals);
  }
  py::dict all;
  all["text"] = to_str(text);
  all["json"] = to_str(report::json_text(json));
  all["chart"] = to_str(draw::to_svg(draw::draw_chart(chart)));
  all["drive"] = to_array(std::move(comparison.drive));
  all["drive_unit"] = comparison.turning ? std::string("rad") : comparison.unit;
  all["error_along"] = along;
  all["overloads"] = overloads;
  return all;
}

}  // namespace

void bind_comparisons(py::class_<MechanismModel, std::shared_ptr<MechanismModel>>& model) {
  model.def("compare", &compared);
}

}  // namespace oblique::python
