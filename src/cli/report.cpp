// SPDX-License-Identifier: MIT
#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "mechanism_report.h"
#include "output_files.h"
#include "patch_choice.h"
#include "picture_output.h"
#include "terminal.h"

namespace oblique::cli {
ExitStatus report_mechanism(const Session& session, const ReportRequest& request) {
  check_output(request.output, ".html");
  const Theme theme = theme_option(request.theme);
  const BlockLibrary library = session.blocks();
  const Mechanism mechanism = read_mechanism(request.mechanism);
  MechanismReport report{mechanism, library, {}, nullptr, {}};
  if (!request.machine.empty()) {
    report.machine = find_machine(request.machine);
    if (report.machine == nullptr) throw ReadError(unknown_machine(request.machine));
  }
  report.options = patch_options(request.patch);
  Progress progress("comparing");
  report.progress = [&](double fraction) { progress.show(fraction); };
  save(request.output, report.page().text(theme));
  return ExitStatus::done;
}

}  // namespace oblique::cli
