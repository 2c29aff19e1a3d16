// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/report/expectation_check.h>
#include <oblique/solve/run.h>
#include <oblique/solve/static_test.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/ensemble/study/family.h>
#include <oblique/network/assembly/network.h>
#include <oblique/report/atlas/lesson_check.h>
#include <oblique/report/atlas/published_check.h>
#include <oblique/report/run_chart.h>
#include <oblique/report/run_text.h>
#include <oblique/report/study/family_report.h>
#include <oblique/report/text_table.h>
#include <oblique/text/file.h>
#include "terminal/output_files.h"
#include "terminal/plot_output.h"
#include "terminal/signals.h"
#include "terminal/table_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

std::string without_blanks_around(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

diagram::ParameterOverride parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw text::ReadError(text::Diagnostic{{},
                                           fmt::format("--set {}: this sets nothing", text),
                                           "block.parameter=value",
                                           "for example --set c.gain=1e4"});
  }
  return {without_blanks_around(text.substr(0, equals)), without_blanks_around(text.substr(equals + 1))};
}

/// The columns that fit on a terminal, and what became of the others.
std::string table_of(const solve::Trajectory& trajectory, std::size_t column_width = 14) {
  const std::size_t all = trajectory.columns().size();
  const std::size_t shown = std::min(all, columns_that_fit(column_width));
  std::string text = report::rows_of(trajectory, shown).text();
  if (shown < all) {
    text += fmt::format("({} more columns; -o FILE.csv writes all of them, and all {} rows)\n", all - shown,
                        trajectory.rows());
  }
  return text;
}

/// A family is runs from the start to the end, and nothing else.
void check_family(const RunRequest& request) {
  const char* const other = request.check                  ? "--check"
                            : request.halt_on_overload     ? "--halt-on-overload"
                            : request.static_test          ? "--static-test"
                            : !request.save.empty()        ? "--save"
                            : !request.from.empty()        ? "--from"
                            : request.events               ? "--events"
                            : request.trust                ? "--trust"
                            : !request.sensitivity.empty() ? "--sensitivity"
                                                           : nullptr;
  if (other == nullptr) return;
  throw text::ReadError(
      text::Diagnostic{{},
                       fmt::format("--vary runs the diagram several times, and {} is of one run", other),
                       "one of the two",
                       {}});
}

void check_request(const RunRequest& request) {
  if (!request.vary.empty()) check_family(request);
  const bool columns_are_drawn = !request.plot.empty();
  check_table_output(request.output, columns_are_drawn ? std::vector<std::string>{} : request.columns);
  if (request.plot.empty() && !request.against.empty())
    throw text::ReadError(text::Diagnostic{
        {}, "--against chooses the axis of a drawing, and none is asked for", "--plot beside it", {}});
  check_plot(request.plot, request.theme);
  if (!request.save.empty()) check_output(request.save, ".toml");
  if (!request.static_test) return;
  const char* const other = request.check                  ? "--check"
                            : request.halt_on_overload     ? "--halt-on-overload"
                            : !request.until.empty()       ? "--until"
                            : !request.output.empty()      ? "-o"
                            : !request.save.empty()        ? "--save"
                            : !request.from.empty()        ? "--from"
                            : request.events               ? "--events"
                            : request.trust                ? "--trust"
                            : !request.sensitivity.empty() ? "--sensitivity"
                            : !request.plot.empty()        ? "--plot"
                                                           : nullptr;
  if (other == nullptr) return;
  throw text::ReadError(
      text::Diagnostic{{},
                       fmt::format("--static-test runs nothing, so {} has nothing to work on", other),
                       "one of the two",
                       {}});
}

/// Refuses a name of --columns, "x" or "x (c.gain = 100)", of which there is no output before the family is
/// run.
void check_outputs(const std::vector<text::TableColumn>& columns, std::vector<std::string> names) {
  for (std::string& name : names) {
    const bool is_output =
        std::any_of(columns.begin(), columns.end(), [&](const auto& column) { return column.name == name; });
    if (!is_output) name = name.substr(0, name.rfind(" ("));
  }
  const ColumnChoice known(columns, names);
}

/// Runs the diagram with each value of --vary.
ExitStatus run_family(const RunRequest& request, const diagram::Diagram& diagram,
                      const diagram::BlockLibrary& library,
                      const std::vector<diagram::ParameterOverride>& overrides) {
  const std::size_t equals = request.vary.find('=');
  if (equals == std::string::npos || equals == 0)
    throw text::ReadError(text::Diagnostic{{},
                                           fmt::format("--vary {}: this varies nothing", request.vary),
                                           "NAME=VALUES",
                                           "for example --vary c.gain=1e2,1e3,1e4"});
  const ensemble::Variation variation{
      request.vary.substr(0, equals), request.vary.substr(equals + 1), {{}, {}, {"vary", request.vary}}};
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library, overrides);
  solve::RunOptions options = solve::options_of(diagram.run);
  const std::vector<text::TableColumn> columns = solve::run_columns(flat, options);
  std::optional<report::DrawnColumns> drawn;
  if (!request.plot.empty()) {
    drawn = report::drawn_columns(columns, {request.columns, request.against});
    report::ask_for_curves(options, columns.size());
  }
  check_outputs(columns, request.columns);
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const ensemble::Family family =
      ensemble::run_family(diagram, library, overrides, variation, options, threads);
  const solve::Trajectory table = report::table_of(family, columns);
  const std::size_t width = table.columns().back().name.size() + 2;
  if (!plots_in_terminal(request.plot)) print(table_of(table, width));
  if (drawn) {
    plot(report::chart_of(family, columns, report::rounding_of(flat, options), *drawn, diagram.title),
         request.plot, plot_theme(request.theme));
  }
  if (!request.output.empty()) {
    const ColumnChoice choice(table.columns(), report::names_in_table(family, columns, request.columns));
    TableOutput file(request.output, choice, table.rows());
    file.add(table.values());
    file.finish();
  }
  bool failed = false;
  for (std::size_t k = 0; k < family.runs.size(); ++k) {
    for (const text::Diagnostic& warning : family.runs[k].run.warnings)
      note(fmt::format("warning: with {}: {}\n", family.label(k), text::to_string(warning, command_line())));
    if (family.runs[k].failure.empty()) continue;
    note(fmt::format("FAILED with {}: {}\n", family.label(k), family.runs[k].failure));
    failed = true;
  }
  return failed ? ExitStatus::solver_failed : ExitStatus::done;
}

/// What --check holds a run against.
struct Claims {
  std::vector<diagram::Expectation> expectations, published;
  bool of_step = false, of_question = false;

  std::vector<diagram::Expectation> all() const {
    std::vector<diagram::Expectation> both = expectations;
    both.insert(both.end(), published.begin(), published.end());
    return both;
  }
};

/// A step's expectations, or those of a question that is answered, or all that the diagram is known to give.
/// Throws DiagramError where there is nothing to check.
Claims claims_of(const RunRequest& request, const diagram::Diagram& diagram,
                 const std::vector<diagram::ParameterOverride>& settings) {
  Claims claims;
  if (!request.check) return claims;
  if (request.step) {
    claims.of_step = true;
    claims.expectations = report::lesson_step(diagram, *request.step).expectations;
    if (!claims.expectations.empty()) return claims;
    throw diagram::DiagramError(
        text::Diagnostic{{diagram.file, {}},
                         fmt::format("there is nothing to check: step {} has no 'expect'", *request.step),
                         R"(expect = { "side at pi" = { value = 0.7, within = 1e-4 } } in [[lesson.step]])",
                         {}});
  }
  if (report::is_answered(diagram, settings)) {
    claims.of_question = true;
    claims.expectations = diagram.lesson->question->expectations;
    return claims;
  }
  claims.expectations = diagram.expectations;
  claims.published = report::published_expectations(diagram);
  const bool asks = diagram.lesson && diagram.lesson->question;
  const bool was_published = diagram.published && !diagram.published->values.empty();
  if (!claims.expectations.empty() || was_published || asks) return claims;
  throw diagram::DiagramError(
      text::Diagnostic{{diagram.file, {}},
                       "there is nothing to check: the diagram has no [expect]",
                       R"([expect] with lines such as "side at pi" = { value = 0.7, within = 1e-4 })",
                       {}});
}

/// Holds the run against them and prints a line for each.
ExitStatus check(const Claims& claims, const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                 const std::vector<diagram::ParameterOverride>& settings, const solve::Run& result) {
  const std::vector<report::ExpectationResult> checked =
      report::check_expectations(claims.expectations, result);
  bool good = std::all_of(checked.begin(), checked.end(), [](const auto& r) { return r.met; });
  if (claims.of_question) {
    print("\n" + report::verdict_text(*diagram.lesson->question, checked));
    return good ? ExitStatus::done : ExitStatus::no;
  }
  print("\n" + report::to_text(checked));
  if (!claims.of_step) {
    const std::vector<report::PublishedResult> published =
        report::check_published(diagram, library, settings, result);
    good =
        good && std::all_of(published.begin(), published.end(), [](const auto& r) { return r.is_known(); });
    print(report::to_text(published) + report::open_question_text(diagram));
    note(report::warnings_text(published, command_line()));
  }
  return good ? ExitStatus::done : ExitStatus::no;
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
  std::vector<diagram::ParameterOverride> overrides;
  if (request.step) overrides = report::lesson_step(diagram, *request.step).set;
  for (const std::string& text : request.settings) overrides.push_back(parse_override(text));
  const Claims claims = claims_of(request, diagram, overrides);
  if (!request.vary.empty()) return run_family(request, diagram, library, overrides);

  const diagram::FlatDiagram flat = diagram::flatten(diagram, library, overrides);
  solve::RunOptions options = solve::options_of(diagram.run);
  options.sensitivity = request.sensitivity;
  const std::vector<text::TableColumn> columns = solve::run_columns(flat, options);
  const ColumnChoice choice(columns, request.columns);
  std::optional<report::DrawnColumns> drawn;
  if (!request.plot.empty()) drawn = report::drawn_columns(columns, {request.columns, request.against});
  if (request.static_test) {
    const diagram::FlatDiagram ideal = diagram::flatten_on_ideal_elements(diagram, library, overrides);
    const network::Program program(network::assemble(ideal));
    print(report::static_test_text(solve::static_test(program, diagram.file)));
    return ExitStatus::done;
  }
  const network::Program program(network::assemble(flat));
  options.halt_on_overload = request.halt_on_overload;
  options.trust = request.trust;
  options.watch_overloads = diagram.machine.profile != "ideal";
  if (!request.from.empty()) {
    options.from = solve::parse_run_state(text::read_file(request.from), request.from);
    options.from->turned = true;  // by --set, or in the file
    if (!(options.until > options.from->time)) {
      throw text::ReadError(
          text::Diagnostic{{request.from, {}},
                           fmt::format("the state is that of t = {} s, and the run ends at {} s",
                                       options.from->time, options.until),
                           "a later end of the run",
                           "give a later --until"});
    }
  }
  if (request.check) report::ask_for_expectations(claims.all(), diagram.file, options);
  if (drawn) report::ask_for_curves(options, columns.size());
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
      note(fmt::format("only the first {} columns are drawn; --columns chooses others of the {} more\n",
                       drawn->drawn.size(), drawn->left_out));
    }
  }
  if (request.events) print("\n" + report::events_text(result.events, result.event_count));
  if (!request.output.empty()) {
    TableOutput table(request.output, choice, result.trajectory.rows());
    table.add(result.trajectory.values());
    table.finish();
  }
  if (!request.save.empty()) save(request.save, solve::to_text(result.state));
  if (result.state.time < options.until)
    note(fmt::format("interrupted at t = {:.6g} s\n", result.state.time));
  note(report::solver_text(program, result, options));
  if (result.event_count > 0 && !request.events) {
    note(fmt::format("{}; --events lists them\n",
                     report::count(static_cast<std::size_t>(result.event_count), "event", "events")));
  }
  note(report::warnings_text(result, command_line()));
  note(report::overloads_text(program, result));
  if (result.trust) note(report::trust_text(*result.trust));
  if (result.halted) return ExitStatus::no;
  if (!request.check) return ExitStatus::done;
  return check(claims, diagram, library, overrides, result);
}

}  // namespace oblique::cli
