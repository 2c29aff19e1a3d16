// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/diagram_check.h>
#include <oblique/report/diagram_check_json.h>
#include <oblique/report/diagram_check_text.h>
#include <oblique/report/file_kind.h>
#include <oblique/report/mechanism_check_json.h>
#include <oblique/report/mechanism_check_text.h>
#include <oblique/report/pole_chart.h>
#include <oblique/report/text_table.h>
#include <oblique/text/file.h>
#include "terminal/output_files.h"
#include "terminal/plot_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

/// Writes the scaled diagram after running it: it is to give what the other one gave.
void write_scaled(const report::DiagramCheck& check, const diagram::BlockLibrary& library,
                  const std::string& path) {
  const report::ScaledDiagram scaled = report::scaled_by(check, library);
  save(path, diagram::write_diagram(scaled.diagram));
  note(fmt::format("its outputs differ by {:.1e} of their size, at a tolerance of {}; {}\n",
                   scaled.difference, scaled.diagram.run.tolerance,
                   report::count(scaled.overloads, "overload", "overloads")));
  constexpr double kSameOutputs = 1e-3;
  if (scaled.difference > kSameOutputs) {
    note("warning: that is more than the solver's tolerance explains, unless the diagram is chaotic\n");
  }
}

ExitStatus check_diagram(const Session& session, const CheckRequest& request, const std::string& text) {
  const diagram::BlockLibrary library = session.blocks();
  const diagram::Diagram diagram = diagram::parse_diagram(text, request.file);
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  const network::Program program(network::assemble(flat));
  const report::DiagramCheck check = [&] {
    Progress progress("running on trial");
    return report::examine(diagram, flat, program, [&](double fraction) { progress.show(fraction); });
  }();
  if (!plots_in_terminal(request.plot))
    print(request.json ? report::to_json(check) : report::to_text(check, command_line()));
  if (!request.plot.empty())
    plot(report::pole_chart(flat, program, check.analysis.instants,
                            "Eigenvalues along the run: " + diagram.title),
         request.plot, plot_theme(request.theme));
  if (check.analysis.failure) throw solve::SolveError(*check.analysis.failure);
  if (request.rescale) write_scaled(check, library, request.output);
  return ExitStatus::done;
}

ExitStatus check_mechanism(const CheckRequest& request, const std::string& text) {
  if (!request.plot.empty()) {
    throw text::ReadError(text::Diagnostic{{request.file, {}},
                                           "a mechanism has no eigenvalues to plot",
                                           "a diagram for --plot",
                                           "patch it first: oblique patch MECHANISM -o DIAGRAM.toml"});
  }
  if (request.rescale) {
    throw text::ReadError(text::Diagnostic{{request.file, {}},
                                           "a mechanism has no signals to scale",
                                           "a diagram for --rescale",
                                           "patch it first: oblique patch MECHANISM -o DIAGRAM.toml"});
  }
  const report::MechanismCheck check =
      report::examine(mechanism::parse_mechanism(text, request.file), request.file);
  print(request.json ? report::to_json(check) : report::to_text(check));
  return check.finding ? ExitStatus::no : ExitStatus::done;
}

void check_request(const CheckRequest& request) {
  check_plot(request.plot, request.theme);
  if (request.json && plots_in_terminal(request.plot)) {
    throw text::ReadError(text::Diagnostic{
        {}, "--json and --plot - would both print", "one of the two", "--plot FILE.svg beside --json"});
  }
  if (request.rescale && request.output.empty()) {
    throw text::ReadError(text::Diagnostic{{}, "--rescale has no file to write to", "-o NEW.toml", {}});
  }
  if (!request.rescale && !request.output.empty()) {
    throw text::ReadError(text::Diagnostic{
        {}, fmt::format("there is nothing to write to {}", request.output), "--rescale beside -o", {}});
  }
  if (request.rescale) {
    check_output(request.output, ".toml");
  }
}

}  // namespace

ExitStatus check_file(const Session& session, const CheckRequest& request) {
  check_request(request);
  const std::string text = text::read_file(request.file);  // once: it may be a pipe
  if (report::kind_of_file(text, request.file) == report::FileKind::diagram)
    return check_diagram(session, request, text);
  return check_mechanism(request, text);
}

}  // namespace oblique::cli
