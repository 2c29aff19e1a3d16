// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/report/expectation_check.h>
#include <oblique/solve/run.h>
#include <oblique/solve/static_test.h>

#include <oblique/network/assembly/network.h>
#include <oblique/report/run_chart.h>
#include <oblique/report/text_table.h>
#include "terminal/output_files.h"
#include "terminal/plot_output.h"
#include "terminal/signals.h"
#include "terminal/table_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

diagram::ParameterOverride parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw text::ReadError(text::Diagnostic{{},
                                           fmt::format("--set {}: this sets nothing", text),
                                           "block.parameter=value",
                                           "for example --set c.gain=1e4"});
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::string table_of(const solve::Trajectory& trajectory) {
  constexpr std::size_t kMostRows = 21;
  constexpr std::size_t kColumnWidth = 14;
  const std::size_t shown = std::min(trajectory.columns().size(), columns_that_fit(kColumnWidth));
  std::vector<std::string> header, units;
  for (std::size_t c = 0; c < shown; ++c) {
    header.push_back(trajectory.columns()[c].name);
    units.push_back("[" + trajectory.columns()[c].unit + "]");
  }
  report::Table table(header);
  table.add(units);
  for (const std::size_t row : report::spread_rows(trajectory.rows(), kMostRows)) {
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < shown; ++c) cells.push_back(report::short_number(trajectory.at(row, c)));
    table.add(cells);
  }
  std::string text = table.text();
  if (shown < trajectory.columns().size()) {
    text += fmt::format("({} more columns; -o FILE.csv writes all of them, and all {} rows)\n",
                        trajectory.columns().size() - shown, trajectory.rows());
  }
  return text;
}

std::string table_of(const std::vector<solve::EventRecord>& events, long count) {
  report::Table table({"t [s]", "event"});
  for (const solve::EventRecord& event : events) table.add({fmt::format("{:.12g}", event.time), event.what});
  std::string text = "\n" + table.text();
  if (count > static_cast<long>(events.size()))
    text += fmt::format("({} more)\n", count - static_cast<long>(events.size()));
  return text;
}

ExitStatus report_expectations(const diagram::Diagram& diagram, const solve::Run& run) {
  ExitStatus status = ExitStatus::done;
  print("\n");
  for (const report::ExpectationResult& result : report::check_expectations(diagram, run)) {
    if (!result.met) status = ExitStatus::no;
    print(fmt::format("{}  {} = {}, expected {} ± {}\n", result.met ? "ok    " : "FAILED",
                      result.expectation.text, result.actual, result.expectation.value,
                      result.expectation.within));
  }
  return status;
}

std::string table_of(const std::vector<solve::StaticReading>& readings) {
  report::Table table({"element", "", "output", "d/dt"});
  table.add({"", "", "[machine unit]", "[machine unit/s]"});
  for (const solve::StaticReading& reading : readings) {
    const char* const kind = !reading.slope ? "" : reading.at_rest ? "brought to rest" : "state";
    table.add({reading.signal, kind, report::short_number(reading.output),
               reading.slope ? report::short_number(*reading.slope) : ""});
  }
  return table.text(2);
}

void check_request(const RunRequest& request) {
  const bool columns_are_drawn = !request.plot.empty();
  check_table_output(request.output, columns_are_drawn ? std::vector<std::string>{} : request.columns);
  if (request.plot.empty() && !request.against.empty())
    throw text::ReadError(text::Diagnostic{{}, "--against is about a drawing", "--plot beside it", {}});
  check_plot(request.plot, request.theme);
  if (!request.save.empty()) check_output(request.save, ".toml");
  if (!request.static_test) return;
  const char* const other = request.check              ? "--check"
                            : request.halt_on_overload ? "--halt-on-overload"
                            : !request.until.empty()   ? "--until"
                            : !request.output.empty()  ? "-o"
                            : !request.save.empty()    ? "--save"
                            : !request.from.empty()    ? "--from"
                            : request.events           ? "--events"
                            : request.trust            ? "--trust"
                            : !request.plot.empty()    ? "--plot"
                                                       : nullptr;
  if (other == nullptr) return;
  throw text::ReadError(
      text::Diagnostic{{},
                       fmt::format("--static-test runs nothing, so {} has nothing to work on", other),
                       "one of the two",
                       {}});
}

/// The estimate of --trust, as remarks.
std::string trust_text(const solve::Trust& trust) {
  if (trust.checks.empty())
    return fmt::format("trust: no estimate of the errors: {}\n",
                       trust.failure.empty() ? "interrupted" : trust.failure);
  std::string text = "trust: errors of the outputs, from";
  for (std::size_t k = 0; k < trust.checks.size(); ++k) {
    const solve::Trust::Check& check = trust.checks[k];
    text += fmt::format("{} a run at a tolerance of {:.3g} by {}", k == 0 ? "" : " and", check.tolerance,
                        diagram::method_name(check.method));
  }
  report::Table table(
      {"output", "size", "largest error", "digits", "digits at the end", "no digit from [s]"});
  for (const solve::OutputError& output : trust.outputs) {
    table.add({output.name, report::short_number(output.size), fmt::format("{:.1e}", output.largest),
               fmt::format("{}", output.digits(output.largest)),
               fmt::format("{}", output.digits(output.at_end)),
               output.lost ? report::short_number(*output.lost) : ""});
  }
  text += "\n" + table.text();
  if (trust.event_shift > 0)
    text += fmt::format("trust: the times of events differ by {:.1e} s at most\n", trust.event_shift);
  if (trust.events_part) {
    text += fmt::format("warning: from t = {:.6g} s on the runs do not have the same events\n",
                        *trust.events_part);
  }
  if (!trust.failure.empty()) text += fmt::format("trust: one more run ended early: {}\n", trust.failure);
  return text;
}

void note_overloads(const network::Program& program, const solve::Run& run) {
  for (const solve::OverloadRecord& o : run.overloads) {
    const std::string& name = program.signal_names()[o.signal];
    if (run.halted) {
      note(fmt::format("overload: '{}' leaves ±1 machine unit at t = {:.10g} s; the run ends there\n", name,
                       o.first));
      return;
    }
    note(fmt::format("overload: '{}' leaves ±1 machine unit at t = {:.6g} s, peak {:.6g}, {:.6g} s in all\n",
                     name, o.first, o.peak.value, o.duration));
  }
}

}  // namespace

ExitStatus run_diagram(const Session& session, const RunRequest& request) {
  check_request(request);
  const diagram::BlockLibrary library = session.blocks();
  diagram::Diagram diagram = diagram::read_diagram(request.diagram);
  if (!request.until.empty()) diagram.run.until = quantity_option("--until", request.until, "s");
  if (!(diagram.run.until > 0 && std::isfinite(diagram.run.until))) {
    throw text::ReadError(text::Diagnostic{{},
                                           fmt::format("the run would end at t = {} s", diagram.run.until),
                                           "a finite time above 0",
                                           "give --until, or 'until' in [run]"});
  }
  if (request.check && diagram.expectations.empty()) {
    throw diagram::DiagramError(
        text::Diagnostic{{diagram.file, {}},
                         "there is nothing to check: the diagram has no [expect]",
                         R"([expect] with lines such as "side at pi" = { value = 0.7, within = 1e-4 })",
                         {}});
  }
  std::vector<diagram::ParameterOverride> overrides;
  for (const std::string& text : request.settings) overrides.push_back(parse_override(text));

  const diagram::FlatDiagram flat = diagram::flatten(diagram, library, overrides);
  const ColumnChoice choice(solve::output_columns(flat), request.columns);
  std::optional<report::DrawnColumns> drawn;
  if (!request.plot.empty())
    drawn = report::drawn_columns(solve::output_columns(flat), {request.columns, request.against});
  const network::Program program(network::assemble(flat));
  if (request.static_test) {
    print(table_of(solve::static_test(program, diagram.file)));
    return ExitStatus::done;
  }
  solve::RunOptions options = solve::options_of(diagram.run);
  options.halt_on_overload = request.halt_on_overload;
  options.trust = request.trust;
  options.watch_overloads = diagram.machine.profile != "ideal";
  if (!request.from.empty()) {
    options.from = solve::parse_run_state(text::read_file(request.from), request.from);
    if (!(options.until > options.from->time)) {
      throw text::ReadError(
          text::Diagnostic{{request.from, {}},
                           fmt::format("the state is that of t = {} s, and the run ends at {} s",
                                       options.from->time, options.until),
                           "a later end of the run",
                           "give a later --until"});
    }
  }
  if (request.check) report::ask_for_expectations(diagram, options);
  if (drawn) report::ask_for_curves(options, solve::output_columns(flat).size());
  solve::Run result;
  {
    Progress progress("running");
    std::optional<InterruptGuard> guard;
    if (!request.save.empty()) {
      options.interrupted = InterruptGuard::asked;
      // Before the first row there is no state to save, and Ctrl-C ends the program.
      options.on_sample = [&](double, std::span<const double>, std::span<const double>) {
        if (!guard) guard.emplace();
      };
    }
    options.progress = [&](double fraction) { progress.show(fraction); };
    result = solve::run(program, flat, options);
  }
  if (!plots_in_terminal(request.plot)) print(table_of(result.trajectory));
  if (drawn) {
    plot(report::chart_of(result, report::rounding_of(flat, options), *drawn, diagram.title), request.plot,
         plot_theme(request.theme));
    if (drawn->left_out > 0) {
      note(fmt::format("drawn are the first {} columns; --columns names others of the {} more\n",
                       drawn->drawn.size(), drawn->left_out));
    }
  }
  if (request.events) print(table_of(result.events, result.event_count));
  if (!request.output.empty()) {
    TableOutput table(request.output, choice, result.trajectory.rows());
    table.add(result.trajectory.values());
    table.finish();
  }
  if (!request.save.empty()) save(request.save, solve::to_text(result.state));
  if (result.state.time < options.until)
    note(fmt::format("interrupted at t = {:.6g} s\n", result.state.time));
  const solve::SolverStatistics& s = result.statistics;
  note(fmt::format("{}, {}; {} (relative tolerance {}), {:.3g} ms\n",
                   report::count(program.n_states(), "state", "states"),
                   report::count(program.loops().size(), "algebraic loop", "algebraic loops"),
                   report::count(static_cast<std::size_t>(s.steps), "step", "steps"), options.tolerance,
                   1e3 * result.seconds));
  if (program.n_states() > 0) {
    note(fmt::format("method {}: {}\n", diagram::method_name(result.method.method), result.method.reason));
  }
  if (result.event_count > 0 && !request.events) {
    note(fmt::format("{}; --events lists them\n",
                     report::count(static_cast<std::size_t>(result.event_count), "event", "events")));
  }
  constexpr double kCoarseForAdams = 1e-3;
  if (result.method.method == diagram::IntegrationMethod::adams && options.tolerance > kCoarseForAdams) {
    note(fmt::format("warning: at a tolerance of {} Adams lets oscillations grow; 1e-3 or less is safe\n",
                     options.tolerance));
  }
  for (const text::Diagnostic& warning : result.warnings) note("warning: " + message(warning) + "\n");
  note_overloads(program, result);
  if (result.trust) note(trust_text(*result.trust));
  if (result.halted) return ExitStatus::no;
  return request.check ? report_expectations(diagram, result) : ExitStatus::done;
}

}  // namespace oblique::cli
