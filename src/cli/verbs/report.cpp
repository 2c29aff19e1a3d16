// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/read_mechanism.h>

#include <fmt/format.h>

#include <oblique/report/atlas/diagram_report.h>
#include <oblique/report/file_kind.h>
#include <oblique/report/mechanism_report.h>
#include <oblique/text/file.h>
#include "terminal/output_files.h"
#include "terminal/picture_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"
#include "verbs/patch_choice.h"

namespace oblique::cli {
namespace {

void report_on_mechanism(const diagram::BlockLibrary& library, const ReportRequest& request,
                         const std::string& text, draw::Theme theme) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, request.file);
  report::MechanismReport report{mechanism, library, {}, nullptr, {}, command_line()};
  if (!request.machine.empty()) {
    report.machine = diagram::find_machine(request.machine);
    if (report.machine == nullptr) throw text::ReadError(diagram::unknown_machine(request.machine));
  }
  report.options = patch_options(request.patch);
  Progress progress("comparing");
  report.progress = [&](double fraction) { progress.show(fraction); };
  save(request.output, report.page().text(theme));
}

/// A diagram is no patch that is to be made, and says itself which machine it is for.
void check_diagram_request(const ReportRequest& request) {
  const PatchChoice usual;
  const PatchChoice& patch = request.patch;
  const char* const other = !request.machine.empty()       ? "--machine"
                            : patch.gain != usual.gain     ? "--gain"
                            : !patch.bandwidth.empty()     ? "--bandwidth"
                            : patch.method != usual.method ? "--method"
                            : !patch.triads.split.empty()  ? "--split"
                            : !patch.triads.slower.empty() ? "--slower"
                                                           : nullptr;
  if (other == nullptr) return;
  throw text::ReadError(
      text::Diagnostic{{request.file, {}},
                       fmt::format("{} is about the patch of a mechanism, and this is a diagram", other),
                       "a report on a diagram without it",
                       {}});
}

void report_on_diagram(const diagram::BlockLibrary& library, const ReportRequest& request,
                       const std::string& text, draw::Theme theme) {
  check_diagram_request(request);
  const report::Programme programme = report::run_programme(request.file, text, library);
  report::DiagramReport report{programme, library, command_line()};
  Progress progress("examining");
  report.progress = [&](double fraction) { progress.show(fraction); };
  save(request.output, report.page().text(theme));
}

}  // namespace

ExitStatus report_file(const Session& session, const ReportRequest& request) {
  check_output(request.output, ".html");
  const draw::Theme theme = theme_option(request.theme);
  const diagram::BlockLibrary library = session.blocks();
  const std::string text = text::read_file(request.file);  // once: it may be a pipe
  if (report::kind_of_file(text, request.file) == report::FileKind::mechanism) {
    report_on_mechanism(library, request, text, theme);
  } else {
    report_on_diagram(library, request, text, theme);
  }
  return ExitStatus::done;
}

}  // namespace oblique::cli
