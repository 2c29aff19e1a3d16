// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "mechanism_report.h"
#include "picture_output.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

double positive(const std::string& option, const std::string& text, std::string_view unit) {
  const double value = quantity_option(option, text, unit);
  if (value > 0 && std::isfinite(value)) return value;
  throw ReadError(Diagnostic{{}, fmt::format("{} {}", option, text), "a finite number above 0", {}});
}

}  // namespace

ExitStatus report_mechanism(const Session& session, const ReportRequest& request) {
  check_output(request.output, ".html");
  check_not_input(request.output, request.mechanism, "mechanism");
  const Theme theme = theme_option(request.theme);
  const BlockLibrary library = session.blocks();
  const Mechanism mechanism = read_mechanism(request.mechanism);
  MechanismReport report{mechanism, library, {}, nullptr, {}};
  if (!request.machine.empty()) {
    report.machine = find_machine(request.machine);
    if (report.machine == nullptr) throw ReadError(unknown_machine(request.machine));
  }
  report.options.method = method_option(request.method);
  report.options.gain = positive("--gain", request.gain, "1");
  if (!request.bandwidth.empty()) report.options.bandwidth = positive("--bandwidth", request.bandwidth, "Hz");
  Progress progress("comparing");
  report.progress = [&](double fraction) { progress.show(fraction); };
  save(request.output, report.page().text(theme));
  return ExitStatus::done;
}

}  // namespace oblique::cli
