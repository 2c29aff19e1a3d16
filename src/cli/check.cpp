// SPDX-License-Identifier: MIT
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/mechanism/obstacle.h>
#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "diagram_check.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

std::string describe(const Mechanism& mechanism, const Group& group) {
  if (group.kind == GroupKind::crank) {
    return fmt::format("crank {}: turns about {} with drive '{}'", group.name,
                       mechanism.points[pivot_of(group)].name, mechanism.drives[group.drives.front()].name);
  }
  if (group.kind == GroupKind::slider) {
    return fmt::format("slider {}: moved along '{}' by drive '{}'", group.name,
                       mechanism.slides[group.slides.front()].name,
                       mechanism.drives[group.drives.front()].name);
  }
  constexpr std::array<const char*, 9> kRoman{"", "I", "II", "III", "IV", "V", "VI", "VII", "VIII"};
  const auto number = static_cast<std::size_t>(group.assur_class);
  const std::string assur_class = number < kRoman.size() ? kRoman[number] : std::to_string(number);
  const std::string driven = group.drives.empty() ? ""
                                                  : fmt::format(", driven inside by '{}'",
                                                                mechanism.drives[group.drives.front()].name);
  if (const auto dyad = dyad_of(group)) {
    return fmt::format("dyad {} (class II, RRR): {} lies {} of {} → {}", group.name,
                       mechanism.points[dyad->c].name, dyad->side > 0 ? "left" : "right",
                       mechanism.points[dyad->p].name, mechanism.points[dyad->q].name);
  }
  if (group.assur_class == 2 && group.kind != GroupKind::general) {
    return fmt::format("dyad {} (class II, {})", group.name, kind_name(group.kind));
  }
  return fmt::format("group {} (class {}, order {}): {}{}", group.name, assur_class, group.order,
                     group.kind == GroupKind::triad ? "a triad, in closed form" : "by Newton's method",
                     driven);
}

/// What keeps the mechanism from turning; nothing where it turns, or is a structure.
std::optional<std::string> obstacle_of(const Mechanism& mechanism, const Structure& structure) {
  if (mechanism.drives.empty()) return std::nullopt;
  const auto obstacle = find_obstacle(mechanism, structure);
  if (!obstacle) return std::nullopt;
  return fmt::format(
      "over one turn the group {} {} at t = {:.6g} s", structure.groups[obstacle->group].name,
      obstacle->status == oblique::Status::open ? "cannot be assembled" : "passes a dead centre",
      obstacle->time);
}

std::string mechanism_text(const std::string& path, const Mechanism& mechanism, const Structure& structure,
                           const std::optional<std::string>& finding) {
  std::string text = fmt::format("{}: a mechanism, \"{}\"\n", path, mechanism.title);
  text += fmt::format("  {}, mobility {}, {}\n", count(mechanism.bodies.size(), "body", "bodies"),
                      mobility(mechanism), count(mechanism.drives.size(), "drive", "drives"));
  for (const Group& group : structure.groups) text += fmt::format("  {}\n", describe(mechanism, group));
  if (finding) return text + fmt::format("no: {}\n", *finding);
  return text + (mechanism.drives.empty()
                     ? "ok: a structure, which can be assembled and does not move\n"
                     : "ok: it can be assembled over the whole turn, without dead centres\n");
}

std::string mechanism_json(const std::string& path, const Mechanism& mechanism, const Structure& structure,
                           const std::optional<std::string>& finding) {
  nlohmann::ordered_json groups = nlohmann::ordered_json::array();
  for (const Group& group : structure.groups) {
    groups.push_back({{"name", group.name}, {"description", describe(mechanism, group)}});
  }
  nlohmann::ordered_json json{{"file", path},
                              {"kind", "mechanism"},
                              {"title", mechanism.title},
                              {"bodies", mechanism.bodies.size()},
                              {"mobility", mobility(mechanism)},
                              {"drives", mechanism.drives.size()}};
  json["groups"] = std::move(groups);
  json["ok"] = !finding;
  json["finding"] = finding ? nlohmann::ordered_json(*finding) : nlohmann::ordered_json(nullptr);
  return json.dump(2) + "\n";
}

ExitStatus check_mechanism(const CheckRequest& request, const std::string& text) {
  if (request.rescale) {
    throw ReadError(Diagnostic{{request.file, {}},
                               "a mechanism has no signals to scale",
                               "a diagram for --rescale",
                               "patch it first: oblique patch MECHANISM -o DIAGRAM.toml"});
  }
  const Mechanism mechanism = parse_mechanism(text, request.file);
  const Structure structure = decompose(mechanism);
  const auto finding = obstacle_of(mechanism, structure);
  print((request.json ? mechanism_json : mechanism_text)(request.file, mechanism, structure, finding));
  return finding ? ExitStatus::no : ExitStatus::done;
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
