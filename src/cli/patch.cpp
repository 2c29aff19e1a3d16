// SPDX-License-Identifier: MIT
#include <oblique/patch/patch.h>

#include <fmt/format.h>

#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "machine_patch.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

double positive_option(const std::string& option, const std::string& text, std::string_view unit) {
  const double value = quantity_option(option, text, unit);
  if (!(value > 0))
    throw ReadError(Diagnostic{{}, fmt::format("{} {}", option, text), "a number above 0", {}});
  return value;
}

}  // namespace

PatchMethod method_option(const std::string& text) {
  if (const auto method = parse_patch_method(text)) return *method;
  throw ReadError(Diagnostic{{},
                             fmt::format("--method {}", text),
                             "triangles or gradient",
                             suggest(text, {"triangles", "gradient"})});
}

ExitStatus patch_mechanism(const Session& session, const PatchRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".toml");
  if (!request.output.empty()) check_not_input(request.output, request.mechanism, "mechanism");
  check_machine_request(request);
  PatchOptions options;
  options.method = method_option(request.method);
  options.gain = positive_option("--gain", request.gain, "1");
  if (!request.bandwidth.empty()) options.bandwidth = positive_option("--bandwidth", request.bandwidth, "Hz");
  const Diagram diagram = patch(read_mechanism(request.mechanism), options);
  if (!request.machine.empty()) return patch_for_machine(session, request, diagram);
  const std::string text = write_diagram(diagram);
  if (request.output.empty()) {
    print(text);
  } else {
    save(request.output, text);
    note(fmt::format("run it with: oblique run {}\n", request.output));
  }
  return ExitStatus::done;
}

}  // namespace oblique::cli
