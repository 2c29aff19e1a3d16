// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/read_mechanism.h>

#include <oblique/report/mechanism_report.h>
#include "terminal/output_files.h"
#include "terminal/picture_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"
#include "verbs/patch_choice.h"

namespace oblique::cli {
ExitStatus report_mechanism(const Session& session, const ReportRequest& request) {
  check_output(request.output, ".html");
  const draw::Theme theme = theme_option(request.theme);
  const diagram::BlockLibrary library = session.blocks();
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(request.mechanism);
  report::MechanismReport report{mechanism, library, {}, nullptr, {}, command_line()};
  if (!request.machine.empty()) {
    report.machine = diagram::find_machine(request.machine);
    if (report.machine == nullptr) throw text::ReadError(diagram::unknown_machine(request.machine));
  }
  report.options = patch_options(request.patch);
  Progress progress("comparing");
  report.progress = [&](double fraction) { progress.show(fraction); };
  save(request.output, report.page().text(theme));
  return ExitStatus::done;
}

}  // namespace oblique::cli
