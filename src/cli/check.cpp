// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <oblique/mechanism/obstacle.h>
#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "diagram_check.h"
#include "mechanism_check.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

/// What keeps the mechanism from turning; nothing where it turns, or is a structure.
std::optional<std::string> obstacle_of(const Mechanism& mechanism, const Structure& structure) {
  if (mechanism.drives.empty()) return std::nullopt;
  // one that moves a slide goes to and fro between its limits
  if (mechanism.drives.front().slide && !mechanism.motion.until) return std::nullopt;
  const auto obstacle = find_obstacle(mechanism, structure);
  if (!obstacle) return std::nullopt;
  return fmt::format(
      "over one turn the group {} {} at t = {:.6g} s", structure.groups[obstacle->group].name,
      obstacle->status == oblique::Status::open ? "cannot be assembled" : "passes a dead centre",
      obstacle->time);
}

ExitStatus check_mechanism(const CheckRequest& request, const std::string& text) {
  if (request.rescale) {
    throw ReadError(Diagnostic{{request.file, {}},
                               "a mechanism has no signals to scale",
                               "a diagram for --rescale",
                               "patch it first: oblique patch MECHANISM -o DIAGRAM.toml"});
  }
  MechanismCheck check;
  check.file = request.file;
  check.mechanism = parse_mechanism(text, request.file);
  check.structure = decompose(check.mechanism);
  check.finding = obstacle_of(check.mechanism, check.structure);
  check.analysis = analyse(check.mechanism, check.structure);
  print(request.json ? to_json(check) : to_text(check));
  return check.finding ? ExitStatus::no : ExitStatus::done;
}

void check_request(const CheckRequest& request) {
  if (request.rescale && request.output.empty()) {
    throw ReadError(Diagnostic{{}, "--rescale has no file to write to", "-o NEW.toml", {}});
  }
  if (!request.rescale && !request.output.empty()) {
    throw ReadError(Diagnostic{
        {}, fmt::format("there is nothing to write to {}", request.output), "--rescale beside -o", {}});
  }
  if (request.rescale) {
    check_output(request.output, ".toml");
    check_not_input(request.output, request.file, "diagram");
  }
}

}  // namespace

ExitStatus check_file(const Session& session, const CheckRequest& request) {
  check_request(request);
  const std::string text = read_file(request.file);  // once: it may be a pipe
  const Document document = parse_document(text, request.file);
  const Value* const format = document.root.find("format");
  const std::string name = format != nullptr ? format->text : "";
  if (name == "oblique-diagram/1") return check_diagram(session, request, text);
  if (name == "oblique-mechanism/1") return check_mechanism(request, text);
  throw ReadError(
      Diagnostic{{request.file, {1, 1}},
                 "this is neither a diagram nor a mechanism",
                 R"(format = "oblique-diagram/1" or "oblique-mechanism/1" at the head of the file)",
                 {}});
}

}  // namespace oblique::cli
