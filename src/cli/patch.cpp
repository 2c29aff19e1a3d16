// SPDX-License-Identifier: MIT
#include <oblique/patch/patch.h>

#include <fmt/format.h>

#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
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

ExitStatus patch_mechanism(const Session&, const PatchRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".toml");
  if (!request.output.empty()) check_not_input(request.output, request.mechanism, "mechanism");
  PatchOptions options;
  options.method = method_option(request.method);
  options.gain = positive_option("--gain", request.gain, "1");
  if (!request.bandwidth.empty()) options.bandwidth = positive_option("--bandwidth", request.bandwidth, "Hz");
  options.derivatives = request.derivatives;
  const std::string text = write_diagram(patch(read_mechanism(request.mechanism), options));
  if (request.output.empty()) {
    print(text);
  } else {
    save(request.output, text);
    note(fmt::format("run it with: oblique run {}\n", request.output));
  }
  return ExitStatus::done;
}

}  // namespace oblique::cli
