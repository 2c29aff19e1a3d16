// SPDX-License-Identifier: MIT
#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include <oblique/ensemble/plan/plan_file.h>
#include <oblique/ensemble/study/study.h>
#include <oblique/report/file_kind.h>
#include <oblique/report/study/effects.h>
#include <oblique/report/study/study_chart.h>
#include <oblique/report/study/study_text.h>
#include <oblique/text/file.h>
#include <oblique/text/quantity.h>
#include <oblique/text/trimmed.h>
#include "terminal/output_files.h"
#include "terminal/picture_output.h"
#include "terminal/plot_output.h"
#include "terminal/signals.h"
#include "terminal/table_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

[[noreturn]] void refuse(std::string what, std::string expected, std::string remedy = {}) {
  throw text::ReadError(text::Diagnostic{{}, std::move(what), std::move(expected), std::move(remedy)});
}

/// The place of what an option says.
text::Place option(const char* name, const std::string& value) {
  return {{}, {}, {name, value}};
}

ensemble::Variation variation_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    refuse(fmt::format("--vary {}: this varies nothing", text), "NAME=VALUES",
           "for example --vary c.gain=1e2..1e6:5:log");
  return {text::trimmed(text.substr(0, equals)), text::trimmed(text.substr(equals + 1)),
          option("vary", text)};
}

/// "NAME = EXPRESSION", or the expression alone.
ensemble::Measure measure_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  const bool is_comparison = equals == std::string::npos || equals == 0 || text.substr(equals, 2) == "==" ||
                             std::string_view("<>!").find(text[equals - 1]) != std::string_view::npos ||
                             text.substr(0, equals).find('(') != std::string::npos;
  const text::Place place = option("measure", text);
  if (is_comparison) return {text::trimmed(text), text, place};
  return {text::trimmed(text.substr(0, equals)), text::trimmed(text.substr(equals + 1)), place};
}

ensemble::Scattered scattered_of(const std::string& text, const diagram::BlockLibrary& library) {
  const std::size_t equals = text.find('='), dot = text.substr(0, equals).rfind('.');
  if (equals == std::string::npos || dot == std::string::npos)
    refuse(fmt::format("--scatter {}: nothing scatters", text), "TYPE.PARAMETER=±HALF-WIDTH",
           "for example --scatter multiplier.error=0.1%");
  ensemble::Scattered scattered{text::trimmed(text.substr(0, dot)),
                                text::trimmed(text.substr(dot + 1, equals - dot - 1)), 0,
                                option("scatter", text)};
  std::string width = text::trimmed(text.substr(equals + 1));
  for (const std::string_view sign : {"±", "+-", "+/-"}) {
    if (width.starts_with(sign)) width = text::trimmed(width.substr(sign.size()));
  }
  text::Unit unit;
  if (const diagram::BlockDefinition* const definition = library.find(scattered.block)) {
    if (const auto index = definition->find_parameter(scattered.parameter))
      unit = text::parse_unit(definition->parameters[*index].unit).value_or(unit);
  }
  scattered.half_width = quantity_option("--scatter", width, unit.name);
  scattered.in_percent = width.find('%') != std::string::npos;
  return scattered;
}

ensemble::Plan plan_of(const SweepRequest& request, const diagram::BlockLibrary& library, bool mechanism) {
  ensemble::Plan plan;
  plan.subject = request.file;
  plan.mechanism = mechanism;
  plan.runs = request.runs;
  plan.seed = request.seed;
  if (request.latin && request.sobol) refuse("--latin and --sobol both choose the points", "one of the two");
  if (request.latin) plan.sampling = ensemble::Sampling::latin_hypercube;
  if (request.sobol) plan.sampling = ensemble::Sampling::sobol;
  for (const std::string& text : request.vary) plan.vary.push_back(variation_of(text));
  for (const std::string& text : request.scatter) plan.scatter.push_back(scattered_of(text, library));
  for (const std::string& text : request.measures) plan.measures.push_back(measure_of(text));
  if (!request.tolerance_of_elements.empty()) {
    plan.tolerance_of_elements =
        quantity_option("--tolerance-of-elements", request.tolerance_of_elements, "1");
  }
  plan.machine = request.machine;
  if (!request.tolerance.empty()) plan.tolerance = quantity_option("--tolerance", request.tolerance, "1");
  plan.samples = request.samples;
  if (!mechanism && (!request.gain.empty() || !request.method.empty()))
    refuse(fmt::format("--{} is of a mechanism's patch, and {} is a diagram",
                       request.gain.empty() ? "method" : "gain", request.file),
           "--vary 'c.gain=…' of a block of the diagram");
  if (!request.gain.empty()) plan.gain = quantity_option("--gain", request.gain, "1");
  if (!request.method.empty()) plan.method = request.method;
  return plan;
}

void write(const report::StudyResult& result, const std::string& path) {
  const ColumnChoice all(result.columns, {});
  TableOutput table(path, all, result.done.rows.size());
  for (const ensemble::StudyRow& row : result.done.rows) table.add(row.values);
  table.finish();
}

void draw(const report::StudyResult& result, const SweepRequest& request) {
  constexpr std::size_t kMostOfCurves = 2;  // varied names
  if (!plots_in_terminal(request.plot)) {
    save_picture(report::picture_of(result), request.plot, plot_theme(request.theme));
  } else if (result.n_varied > kMostOfCurves) {
    print(report::effects_text(result));
  } else {
    plot(report::chart_of(result), request.plot, plot_theme(request.theme));
  }
}

}  // namespace

ExitStatus sweep(const Session& session, const SweepRequest& request) {
  check_table_output(request.output, {});
  check_plot(request.plot, request.theme);
  if (!request.plan.empty()) check_output(request.plan, ".toml");
  const diagram::BlockLibrary library = session.blocks();
  const std::string text = text::read_file(request.file);
  const bool mechanism = report::kind_of_file(text, request.file) == report::FileKind::mechanism;
  const int threads =
      request.jobs > 0 ? request.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const ensemble::Plan plan = plan_of(request, library, mechanism);
  const ensemble::Study study(plan, text, library, threads);
  if (!request.plan.empty()) {
    save(request.plan, ensemble::write_plan({study.title(), OBLIQUE_VERSION, plan}, request.plan));
    if (request.output.empty() && request.plot.empty()) return ExitStatus::done;
  }
  report::StudyResult result;
  result.columns = study.columns();
  result.n_varied = study.n_varied();
  for (std::size_t k = 0; k < result.n_varied; ++k) result.logarithmic.push_back(study.is_logarithmic(k));
  result.drawn = study.n_drawn();
  result.grid = plan.sampling == ensemble::Sampling::grid;
  result.title = study.title();
  const std::uint64_t runs = study.runs();
  bool interrupted = false;
  {
    Progress progress("running");
    const InterruptGuard guard;
    result.done = study.run(
        0, runs,
        [&](std::uint64_t done) { progress.show(static_cast<double>(done) / static_cast<double>(runs)); },
        [&] { return interrupted = interrupted || InterruptGuard::asked(); });
  }
  interrupted = result.done.rows.size() < runs;
  if (interrupted) {
    note(fmt::format("interrupted: {} of {} machines were run{}\n", result.done.rows.size(), runs,
                     result.done.rows.empty() ? "; there is nothing to write" : ""));
  }
  if (result.done.rows.empty()) return ExitStatus::no;
  if (!plots_in_terminal(request.plot)) {
    constexpr std::size_t kColumnWidth = 14;
    if (request.output.empty()) print(report::rows_text(result, columns_that_fit(kColumnWidth)) + "\n");
    print(report::summary_text(result));
    if (const std::string orders = report::order_text(result); !orders.empty()) print("\n" + orders);
    if (result.n_varied > 1) print("\n" + report::effects_text(result));
  }
  if (!request.output.empty()) write(result, request.output);
  if (!request.plot.empty()) draw(result, request);
  note(report::count_text(result));
  return result.done.count.failed == result.done.rows.size() ? ExitStatus::solver_failed : ExitStatus::done;
}

}  // namespace oblique::cli
