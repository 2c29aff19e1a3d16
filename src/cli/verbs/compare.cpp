// SPDX-License-Identifier: MIT
#include <oblique/compare/compare.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/commission/diagram_on_machine.h>
#include <oblique/commission/on_machine.h>
#include <oblique/compare/budget.h>
#include <oblique/compare/machine_comparison.h>
#include <oblique/compare/monte_carlo.h>
#include <oblique/mechanism/model/read_mechanism.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/budget_report.h>
#include <oblique/report/comparison_chart.h>
#include <oblique/report/comparison_report.h>
#include <oblique/report/file_kind.h>
#include <oblique/report/json_text.h>
#include <oblique/report/judgement_text.h>
#include <oblique/report/machine_comparison_report.h>
#include <oblique/report/monte_carlo_report.h>
#include <oblique/report/text_table.h>
#include <oblique/text/file.h>
#include "terminal/output_files.h"
#include "terminal/plot_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"
#include "verbs/patch_choice.h"

namespace oblique::cli {
namespace {

[[noreturn]] void refuse_comparison(const std::string& what, const std::string& expected,
                                    const std::string& remedy = {}) {
  throw text::ReadError(text::Diagnostic{{}, what, expected, remedy});
}

/// Positive finite numbers of an option that takes several, each once.
std::vector<double> numbers_option(const std::string& option, const std::vector<std::string>& texts,
                                   std::string_view unit, const std::string& expected) {
  std::vector<double> values;
  for (const std::string& text : texts) {
    values.push_back(quantity_option(option, text, unit));
    if (!(values.back() > 0 && std::isfinite(values.back())))
      refuse_comparison(fmt::format("{} {}", option, text), expected);
    if (std::find(values.begin(), values.end() - 1, values.back()) != values.end() - 1) values.pop_back();
  }
  return values;
}

int threads_of(const CompareRequest& request) {
  return request.threads > 0 ? request.threads
                             : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

compare::CompareOptions options_of(const CompareRequest& request) {
  compare::CompareOptions options;
  options.methods.clear();
  for (const std::string& name : request.methods) {
    const patch::PatchMethod method = method_option(name);
    if (std::find(options.methods.begin(), options.methods.end(), method) == options.methods.end())
      options.methods.push_back(method);
  }
  if (!request.gains.empty())
    options.gains = numbers_option("--gain", request.gains, "1", "finite gains above 0, such as 1e3,1e4,1e5");
  options.bandwidths = numbers_option("--bandwidth", request.bandwidths, "Hz",
                                      "finite bandwidths above 0, such as 10,100 or \"1 kHz\"");
  take_apart(request.triads, options.methods, options.split, options.slower);
  options.threads = threads_of(request);
  return options;
}

/// Says what is missing in the tables; whether a run failed.
bool warn_of(const std::vector<compare::RefusedRun>& refused) {
  for (const compare::RefusedRun& run : refused) {
    std::string name = fmt::format("method {}", patch::method_name(run.method));
    if (run.bandwidth) name += fmt::format(", {:.6g} Hz", *run.bandwidth);
    if (run.gain) name += fmt::format(", gain {:.6g}", *run.gain);
    note(fmt::format("warning: {} is left out: {}\n", name, message(run.why)));
  }
  return std::any_of(refused.begin(), refused.end(), [](const compare::RefusedRun& run) { return run.gain; });
}

/// The one patch that `option` is about: "--machine", "--monte-carlo".
patch::PatchOptions single_patch(const std::string& option, const CompareRequest& request,
                                 const compare::CompareOptions& options) {
  const auto one_of = [&](const char* several, std::size_t n) {
    if (n > 1)
      refuse_comparison(fmt::format("{} with {} of {}", option, report::count(n, "value", "values"), several),
                        "one");
  };
  one_of("--gain", request.gains.size());
  one_of("--bandwidth", options.bandwidths.size());
  one_of("--method", options.methods.size());
  patch::PatchOptions patch;
  patch.method = options.methods.front();
  patch.split = options.split;
  patch.slower = options.slower;
  if (!request.gains.empty()) patch.gain = options.gains.front();
  if (!options.bandwidths.empty()) patch.bandwidth = options.bandwidths.front();
  return patch;
}

/// How the elements scatter: as --tolerance says, or the machine's profile.
std::vector<diagram::BlockFigure> scatters_of(const CompareRequest& request,
                                              const diagram::BlockLibrary& library,
                                              const diagram::MachineProfile* machine) {
  constexpr double kMost = 0.5;  // a factor of two is no tolerance any more
  if (!request.tolerance.empty()) {
    const double tolerance = quantity_option("--tolerance", request.tolerance, "1");
    if (!(tolerance > 0 && tolerance <= kMost))
      refuse_comparison(fmt::format("--tolerance {}", request.tolerance), "a number above 0 and up to 50%");
    return ensemble::scatters_of_tolerance(library, tolerance);
  }
  if (machine == nullptr) {
    refuse_comparison(
        fmt::format("{} without how far the elements scatter", request.budget ? "--budget" : "--monte-carlo"),
        "--tolerance, such as 0.1%, or a --machine");
  }
  if (machine->scatters.empty()) {
    refuse_comparison(fmt::format("nothing is published of how the elements of {} scatter", machine->title),
                      "--tolerance, such as 0.1%");
  }
  return machine->scatters;
}

/// The error below which a machine is good [length unit].
double yield_option(const std::string& text, const mechanism::Mechanism& mechanism) {
  const bool relative = text.ends_with("%");
  const double below = relative ? mechanism.largest_length() * quantity_option("--yield", text, "1")
                                : quantity_option("--yield", text, mechanism.length_unit);
  if (!(below > 0 && std::isfinite(below)))
    refuse_comparison(fmt::format("--yield {}", text),
                      "a part of the largest link above 0, such as 1%, or a length");
  return below;
}

/// How well the part of good machines is to be known.
std::optional<double> until_within_option(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const double within = quantity_option("--until-within", text, "1");
  if (!(within > 0 && within < 1))
    refuse_comparison(fmt::format("--until-within {}", text), "a part above 0 and below 1, such as 1%");
  return within;
}

/// Errors are in `unit`; `draw` runs the machines.
template <class Draw>
report::MonteCarloReport draw_elements(const CompareRequest& request, const std::string& unit, double size,
                                       const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                                       const diagram::MachineProfile* machine,
                                       std::optional<double> good_below, std::optional<double> until_within,
                                       const Draw& draw) {
  report::MonteCarloReport report;
  report.tolerance = request.tolerance;
  if (request.tolerance.empty()) report.machine = machine->title;
  report.unit = unit;
  report.options.scatters = scatters_of(request, library, machine);
  report.options.runs = request.runs;
  report.options.seed = request.seed;
  report.options.first_run = request.first_run;
  report.options.threads = threads_of(request);
  report.size = size;
  report.options.good_below = good_below;
  report.options.until_within = until_within;
  if (report.options.runs == 1) {
    const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
    for (const ensemble::Draw& drawn :
         ensemble::draw(flat, report.options.scatters, {request.seed, request.first_run})) {
      const diagram::FlatBlock& block = flat.blocks[drawn.block];
      report.draws.emplace_back(block.path + "." + block.definition->parameters[drawn.parameter].name,
                                drawn.value);
    }
  }
  Progress progress("drawing elements");
  report.options.progress = [&](double fraction) { progress.show(fraction); };
  const auto begin = std::chrono::steady_clock::now();
  report.result = draw(report.options);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

/// `differentiate` finds the budget.
template <class Differentiate>
report::BudgetReport budget_of(const CompareRequest& request, const diagram::BlockLibrary& library,
                               const diagram::MachineProfile* machine, const Differentiate& differentiate) {
  report::BudgetReport report;
  report.scatter = request.tolerance.empty() ? fmt::format("as those of {} scatter", machine->title)
                                             : fmt::format("within ±{}", request.tolerance);
  compare::BudgetOptions options;
  options.scatters = scatters_of(request, library, machine);
  Progress progress("differentiating");
  options.progress = [&](double fraction) { progress.show(fraction); };
  report.budget = differentiate(options);
  return report;
}

/// A diagram takes none of the options that say how a mechanism becomes one, and no drawing.
void check_diagram_request(const CompareRequest& request) {
  const CompareRequest usual;
  const std::pair<const char*, bool> options[] = {{"--gain", !request.gains.empty()},
                                                  {"--bandwidth", !request.bandwidths.empty()},
                                                  {"--method", request.methods != usual.methods},
                                                  {"--split", !request.triads.split.empty()},
                                                  {"--slower", !request.triads.slower.empty()},
                                                  {"--plot", !request.plot.empty()}};
  for (const auto& [option, given] : options) {
    if (given)
      refuse_comparison(fmt::format("{} for a diagram", option), "a mechanism beside it", "leave it out");
  }
  if (request.machine.empty() && request.runs == 0 && !request.budget) {
    throw text::ReadError(
        text::Diagnostic{{request.mechanism, {}},
                         "this is a diagram, and nothing is named to hold it against",
                         "--machine NAME, or --tolerance X with --budget or --monte-carlo N",
                         "oblique machines lists the machines"});
  }
}

/// Holds a diagram against its ideal self.
ExitStatus compare_diagram(const diagram::BlockLibrary& library, const CompareRequest& request,
                           const diagram::MachineProfile* machine, const std::string& file) {
  check_diagram_request(request);
  std::optional<double> good_below;
  if (!request.yield.empty()) {
    good_below = quantity_option("--yield", request.yield, "1");
    if (!(*good_below > 0 && std::isfinite(*good_below)))
      refuse_comparison(fmt::format("--yield {}", request.yield),
                        "a part of the largest value of an output above 0, such as 1%");
  }
  const std::optional<double> until_within = until_within_option(request.until_within);
  const diagram::Diagram given = diagram::parse_diagram(file, request.mechanism);
  diagram::Diagram drawn = given;
  std::string told;
  if (machine != nullptr) {
    const commission::DiagramOnMachine patched = commission::put_on_machine(given, library, *machine);
    drawn = patched.made.diagram;
    told = report::machine_text(patched, *machine) + "\n";
  }
  const diagram::FlatDiagram ideal = diagram::flatten_on_ideal_elements(given, library);
  const auto reference = [&] {
    return solve::run(network::Program(network::assemble(ideal)), ideal, solve::options_of(given.run))
        .trajectory;
  };
  std::string text =
      fmt::format("{}{}\n{}", request.mechanism, given.title.empty() ? "" : ": " + given.title, told);
  nlohmann::ordered_json json{{"diagram", request.mechanism}};
  bool failed = false;
  if (machine != nullptr) {
    Progress progress("figure by figure");
    const compare::MachineComparison on_machine = compare::compare_on_machine(
        reference(), drawn, library, *machine, [&](double fraction) { progress.show(fraction); });
    text += report::to_text(on_machine, command_line());
    json["machine"] = report::to_json(on_machine);
  }
  if (request.budget) {
    report::BudgetReport report = budget_of(
        request, library, machine,
        [&](const compare::BudgetOptions& budget) { return compare::error_budget(drawn, library, budget); });
    report.of_outputs = true;
    text += report::to_text(report);
    json["budget"] = report::to_json(report);
  }
  if (request.runs > 0) {
    const solve::Trajectory exact = reference();
    const report::MonteCarloReport report =
        draw_elements(request, "of the largest value", 0, drawn, library, machine, good_below, until_within,
                      [&](const compare::MonteCarloOptions& drawing) {
                        return compare::monte_carlo(exact, drawn, library, drawing);
                      });
    text += report::to_text(report, command_line());
    json["monte_carlo"] = report::to_json(report, request.timings);
    failed = !report.result.worst_run;
  }
  print(request.json ? report::json_text(json) : text);
  if (!request.output.empty()) save(request.output, report::json_text(json));
  return failed ? ExitStatus::solver_failed : ExitStatus::done;
}

}  // namespace

ExitStatus compare_mechanism(const Session& session, const CompareRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".json");
  check_plot(request.plot, request.theme);
  if (request.json && plots_in_terminal(request.plot))
    refuse_comparison("--json and --plot - would both print", "one of the two",
                      "--plot FILE.svg beside --json");
  if (request.timings && !request.json && request.output.empty())
    refuse_comparison("--timings adds to the JSON, and none is written", "--json or -o FILE.json beside it");
  const diagram::BlockLibrary library = session.blocks();
  compare::CompareOptions options = options_of(request);
  const diagram::MachineProfile* const machine =
      request.machine.empty() ? nullptr : diagram::find_machine(request.machine);
  if (machine == nullptr && !request.machine.empty())
    throw text::ReadError(diagram::unknown_machine(request.machine));
  const bool scattered = request.runs > 0 || request.budget;
  if (!request.tolerance.empty() && !scattered)
    refuse_comparison("--tolerance says how elements scatter, and nothing asks for it",
                      "--budget or --monte-carlo N");
  if (scattered) scatters_of(request, library, machine);  // before the work, not after it
  const std::string file = text::read_file(request.mechanism);
  if (report::kind_of_file(file, request.mechanism) == report::FileKind::diagram)
    return compare_diagram(library, request, machine, file);
  patch::PatchOptions single;
  if (machine != nullptr || scattered) {
    const char* const option = machine != nullptr ? "--machine"
                               : request.budget   ? "--budget"
                                                  : "--monte-carlo";
    single = single_patch(option, request, options);
    options.gains = {single.gain};
  }
  const mechanism::Mechanism mechanism =
      patch::within_range(mechanism::parse_mechanism(file, request.mechanism));
  const std::optional<double> good_below =
      request.yield.empty() ? std::nullopt : std::optional(yield_option(request.yield, mechanism));
  const std::optional<double> until_within = until_within_option(request.until_within);
  std::optional<commission::MachinePatch> on_elements;
  diagram::Diagram drawn;  // whose elements scatter
  if (machine != nullptr || scattered) {
    commission::JudgedPatch patched = commission::judged_patch(mechanism, library, single);
    single = patched.options;
    drawn = patched.diagram;
    if (machine != nullptr) {
      on_elements = commission::put_on_machine(mechanism, library, *machine, std::move(patched));
      single = on_elements->options;
      drawn = on_elements->realised;
      if (single.bandwidth) options.bandwidths = {*single.bandwidth};
    }
  }
  compare::Comparison comparison;
  {
    Progress progress("comparing");
    options.progress = [&](double fraction) { progress.show(fraction); };
    comparison = compare::compare(mechanism, library, options);
  }
  std::string text = report::to_text(comparison);
  nlohmann::ordered_json json = report::to_json(comparison, request.timings);
  draw::Chart chart = report::chart_of(comparison);
  bool failed = warn_of(comparison.refused);
  if (machine != nullptr) {
    Progress progress("figure by figure");
    const compare::MachineComparison on_machine = compare::compare_on_machine(
        mechanism, library, *machine, single, [&](double fraction) { progress.show(fraction); });
    text += report::to_text(on_machine, comparison, command_line()) +
            report::bandwidth_text(*on_elements, *machine);
    json["machine"] = report::to_json(on_machine);
  }
  if (request.budget) {
    report::BudgetReport report =
        budget_of(request, library, machine, [&](const compare::BudgetOptions& budget) {
          return compare::error_budget(mechanism, drawn, library, budget);
        });
    report.unit = mechanism.length_unit;
    report.turning = comparison.turning;
    text += report::to_text(report);
    json["budget"] = report::to_json(report);
  }
  if (request.runs > 0) {
    const report::MonteCarloReport report =
        draw_elements(request, mechanism.length_unit, mechanism.largest_length(), drawn, library, machine,
                      good_below, until_within, [&](const compare::MonteCarloOptions& drawing) {
                        return compare::monte_carlo(mechanism, drawn, library, drawing);
                      });
    text += report::to_text(report, command_line());
    // Both sort the errors of ten thousand machines row by row, which takes as long as a tenth of their runs.
    if (request.json || !request.output.empty())
      json["monte_carlo"] = report::to_json(report, request.timings);
    if (!request.plot.empty()) {
      for (draw::Panel& panel : report::panels_of(comparison, report))
        chart.panels.push_back(std::move(panel));
    }
    failed = failed || !report.result.worst_run;
  }
  if (!plots_in_terminal(request.plot)) print(request.json ? report::json_text(json) : text);
  if (!request.plot.empty()) plot(chart, request.plot, plot_theme(request.theme));
  if (!request.output.empty()) save(request.output, report::json_text(json));
  return failed ? ExitStatus::solver_failed : ExitStatus::done;
}

}  // namespace oblique::cli
