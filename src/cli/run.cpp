// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/format.h>

#include <oblique/network/program.h>
#include <oblique/solve/expectation_check.h>
#include <oblique/solve/run.h>

#include "command.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

ParameterOverride parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ReadError(Diagnostic{{},
                               fmt::format("--set {}: this sets nothing", text),
                               "block.parameter=value",
                               "for example --set c.gain=1e4"});
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::string table_of(const Trajectory& trajectory) {
  constexpr std::size_t kMostRows = 21;
  constexpr std::size_t kColumnWidth = 14;
  const std::size_t shown = std::min(trajectory.columns().size(), columns_that_fit(kColumnWidth));
  std::vector<std::string> header, units;
  for (std::size_t c = 0; c < shown; ++c) {
    header.push_back(trajectory.columns()[c].name);
    units.push_back("[" + trajectory.columns()[c].unit + "]");
  }
  Table table(header);
  table.add(units);
  for (const std::size_t row : spread_rows(trajectory.rows(), kMostRows)) {
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < shown; ++c) cells.push_back(short_number(trajectory.at(row, c)));
    table.add(cells);
  }
  std::string text = table.text();
  if (shown < trajectory.columns().size()) {
    text += fmt::format("({} more columns; -o FILE.csv writes all of them, and all {} rows)\n",
                        trajectory.columns().size() - shown, trajectory.rows());
  }
  return text;
}

ExitStatus report_expectations(const Diagram& diagram, const Run& run) {
  ExitStatus status = ExitStatus::done;
  print("\n");
  for (const ExpectationResult& result : check_expectations(diagram, run)) {
    if (!result.met) status = ExitStatus::no;
    print(fmt::format("{}  {} = {}, expected {} ± {}\n", result.met ? "ok    " : "FAILED",
                      result.expectation.text, result.actual, result.expectation.value,
                      result.expectation.within));
  }
  return status;
}

}  // namespace

ExitStatus run_diagram(const Session& session, const RunRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".csv");
  const BlockLibrary library = session.library();
  Diagram diagram = read_diagram(request.diagram);
  if (!request.until.empty()) diagram.run.until = quantity_option("--until", request.until, "s");
  if (!(diagram.run.until > 0 && std::isfinite(diagram.run.until))) {
    throw ReadError(Diagnostic{{},
                               fmt::format("the run would end at t = {} s", diagram.run.until),
                               "a finite time above 0",
                               "give --until, or 'until' in [run]"});
  }
  if (request.check && diagram.expectations.empty()) {
    throw DiagramError(
        Diagnostic{{diagram.file, {}},
                   "there is nothing to check: the diagram has no [expect]",
                   R"([expect] with lines such as "side at pi" = { value = 0.7, within = 1e-4 })",
                   {}});
  }
  std::vector<ParameterOverride> overrides;
  for (const std::string& text : request.settings) overrides.push_back(parse_override(text));

  const FlatDiagram flat = flatten(diagram, library, overrides);
  const Program program(assemble(flat));
  RunOptions options = options_of(diagram.run);
  if (request.check) options.extra_times = expectation_times(diagram, diagram.run.until);
  Run result;
  {
    Progress progress("running");
    options.progress = [&](double fraction) { progress.show(fraction); };
    result = run(program, flat, options);
  }
  print(table_of(result.trajectory));
  if (!request.output.empty()) save(request.output, to_csv(result.trajectory));
  const SolverStatistics& s = result.statistics;
  note(fmt::format(
      "{}, {}; {} (relative tolerance {}), {:.3g} ms\n", count(program.n_states(), "state", "states"),
      count(program.loops().size(), "algebraic loop", "algebraic loops"),
      count(static_cast<std::size_t>(s.steps), "step", "steps"), options.tolerance, 1e3 * result.seconds));
  if (program.n_states() > 0) {
    note(fmt::format("method {}: {}\n", method_name(result.method.method), result.method.reason));
  }
  constexpr double kCoarseForAdams = 1e-5;
  if (result.method.method == IntegrationMethod::adams && options.tolerance > kCoarseForAdams) {
    note(fmt::format("warning: at a tolerance of {} Adams lets oscillations grow; 1e-5 or less is safe\n",
                     options.tolerance));
  }
  return request.check ? report_expectations(diagram, result) : ExitStatus::done;
}

}  // namespace oblique::cli
