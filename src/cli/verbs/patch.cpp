// SPDX-License-Identifier: MIT
#include <oblique/commission/judge.h>

#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include <oblique/compare/branch.h>
#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/report/comparison_report.h>
#include <oblique/report/file_kind.h>
#include <oblique/report/judgement_text.h>
#include <oblique/text/file.h>
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

[[noreturn]] void refuse_option(const std::string& option, const std::string& of, const std::string& has) {
  throw text::ReadError(
      text::Diagnostic{{}, fmt::format("{} for {}", option, has), of + " beside it", "leave it out"});
}

/// A diagram takes none of the options that say how a mechanism becomes one, and needs a machine.
void check_diagram_request(const PatchRequest& request) {
  const PatchRequest usual;
  const std::pair<const char*, bool> options[] = {{"--gain", request.gain != usual.gain},
                                                  {"--bandwidth", !request.bandwidth.empty()},
                                                  {"--method", request.method != usual.method},
                                                  {"--derivatives", request.derivatives},
                                                  {"--split", !request.triads.split.empty()},
                                                  {"--slower", !request.triads.slower.empty()},
                                                  {"--unit", !request.unit.empty()},
                                                  {"--period", !request.period.empty()}};
  for (const auto& [option, given] : options) {
    if (given) refuse_option(option, "a mechanism", "a diagram");
  }
  if (!request.machine.empty()) return;
  throw text::ReadError(text::Diagnostic{{request.mechanism, {}},
                                         "this is a diagram already, and no machine is named to put it on",
                                         "--machine NAME beside it",
                                         "oblique machines lists them"});
}

ExitStatus patch_or_refuse(const Session& session, const PatchRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".toml");
  check_machine_request(request);
  const std::string text = text::read_file(request.mechanism);
  if (report::kind_of_file(text, request.mechanism) == report::FileKind::diagram) {
    check_diagram_request(request);
    machine::ScalingOptions scaling;
    if (!request.time_scale.empty()) scaling.time = positive_option("--time-scale", request.time_scale, "1");
    if (request.segments > 0) scaling.segments = request.segments;
    const diagram::BlockLibrary library = session.blocks();
    return patch_for_machine(library, request, diagram::parse_diagram(text, request.mechanism), scaling);
  }
  if (!request.time_scale.empty()) refuse_option("--time-scale", "a diagram", "a mechanism");
  if (request.segments > 0) refuse_option("--segments", "a diagram", "a mechanism");
  patch::PatchOptions options;
  options.method = method_option(request.method);
  options.gain = gain_option("--gain", request.gain, "1");
  if (!request.bandwidth.empty()) options.bandwidth = gain_option("--bandwidth", request.bandwidth, "Hz");
  options.derivatives = request.derivatives;
  take_apart(request.triads, {options.method}, options.split, options.slower);
  options.force = request.force;
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, request.mechanism);
  if (!request.unit.empty()) options.unit = positive_option("--unit", request.unit, mechanism.length_unit);
  if (!request.period.empty()) options.period = positive_option("--period", request.period, "s");
  const diagram::BlockLibrary library = session.blocks();
  const commission::JudgedPatch patched = commission::judged_patch(mechanism, library, options);
  if (!request.machine.empty()) return patch_for_machine(library, request, mechanism, patched);
  const std::string written = diagram::write_diagram(patched.diagram);
  std::string judgement = report::judgement_text(patched.judgement, command_line());
  if (const auto drive = compare::drive_off_branch(mechanism, patched, library))
    judgement += report::left_branch_text(mechanism, *drive, command_line());
  if (request.output.empty()) {
    note(judgement);
    print(written);
  } else {
    save(request.output, written);
    note(judgement);
    note(fmt::format("run it with: oblique run {}\n", request.output));
  }
  return ExitStatus::done;
}

}  // namespace

ExitStatus patch_file(const Session& session, const PatchRequest& request) {
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
