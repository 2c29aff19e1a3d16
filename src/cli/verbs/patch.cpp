// SPDX-License-Identifier: MIT
#include <oblique/commission/judge.h>

#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include <oblique/diagram/diagram_writer.h>
#include <oblique/report/judgement_text.h>
#include "terminal/output_files.h"
#include "terminal/terminal.h"
#include "verbs/command.h"
#include "verbs/machine_patch.h"
#include "verbs/patch_choice.h"

namespace oblique::cli {
namespace {

double gain_option(const std::string& option, const std::string& text, std::string_view unit) {
  const double value = quantity_option(option, text, unit);
  if (!(value > 0))
    throw text::ReadError(text::Diagnostic{{}, fmt::format("{} {}", option, text), "a number above 0", {}});
  return value;
}

}  // namespace

patch::PatchMethod method_option(const std::string& text) {
  if (const auto method = patch::parse_patch_method(text)) return *method;
  throw text::ReadError(text::Diagnostic{{},
                                         fmt::format("--method {}", text),
                                         "triangles, gradient or paper",
                                         text::suggest(text, {"triangles", "gradient", "paper"})});
}

namespace {

ExitStatus patch_or_refuse(const Session& session, const PatchRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".toml");
  check_machine_request(request);
  patch::PatchOptions options;
  options.method = method_option(request.method);
  options.gain = gain_option("--gain", request.gain, "1");
  if (!request.bandwidth.empty()) options.bandwidth = gain_option("--bandwidth", request.bandwidth, "Hz");
  options.derivatives = request.derivatives;
  take_apart(request.triads, {options.method}, options.split, options.slower);
  options.force = request.force;
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(request.mechanism);
  if (!request.unit.empty()) options.unit = positive_option("--unit", request.unit, mechanism.length_unit);
  if (!request.period.empty()) options.period = positive_option("--period", request.period, "s");
  const diagram::BlockLibrary library = session.blocks();
  const commission::JudgedPatch patched = commission::judged_patch(mechanism, library, options);
  if (!request.machine.empty()) return patch_for_machine(library, request, mechanism, patched);
  const std::string text = diagram::write_diagram(patched.diagram);
  if (request.output.empty()) {
    note(report::judgement_text(patched.judgement, command_line()));
    print(text);
  } else {
    save(request.output, text);
    note(report::judgement_text(patched.judgement, command_line()));
    note(fmt::format("run it with: oblique run {}\n", request.output));
  }
  return ExitStatus::done;
}

}  // namespace

ExitStatus patch_mechanism(const Session& session, const PatchRequest& request) {
  try {
    return patch_or_refuse(session, request);
  } catch (const patch::PatchError& error) {
    if (!error.can_be_forced()) throw;
    text::Diagnostic refusal = error.diagnostics().front();
    refusal.remedy += "; --force writes this one all the same";
    throw patch::PatchError(refusal, error.kind());
  }
}

}  // namespace oblique::cli
