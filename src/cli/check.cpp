// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include "command.h"
#include "diagram_check.h"
#include "file_kind.h"
#include "mechanism_check.h"
#include "output_files.h"
#include "plot_output.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

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
  const MechanismCheck check = examine(mechanism::parse_mechanism(text, request.file), request.file);
  print(request.json ? to_json(check) : to_text(check));
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
  if (kind_of_file(text, request.file) == FileKind::diagram) return check_diagram(session, request, text);
  return check_mechanism(request, text);
}

}  // namespace oblique::cli
