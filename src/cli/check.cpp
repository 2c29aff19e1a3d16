// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/mechanism/obstacle.h>
#include <oblique/mechanism/read_mechanism.h>
#include <oblique/network/program.h>
#include <oblique/solve/rest.h>

#include "command.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

ExitStatus check_diagram(const Session& session, const std::string& path, const std::string& text) {
  const BlockLibrary library = session.library();
  const Diagram diagram = parse_diagram(text, path);
  const FlatDiagram flat = flatten(diagram, library);
  const Program program(assemble(flat));
  print(fmt::format("{}: a diagram, \"{}\"\n", path, diagram.title));
  print(fmt::format("  {}; flattened: {}\n", count(diagram.blocks.size(), "block", "blocks"),
                    count(flat.blocks.size(), "element", "elements")));
  print(fmt::format("  {}, {} of them servo amplifiers brought to rest at the start\n",
                    count(program.n_states(), "state", "states"), rest_states(program).size()));
  for (const Loop& loop : program.loops()) {
    print(fmt::format("  algebraic loop with {}: {}\n", count(loop.unknowns.size(), "unknown", "unknowns"),
                      fmt::join(loop.members, ", ")));
  }
  if (program.loops().empty()) print("  no algebraic loops\n");
  print(fmt::format("  {}\n", count(flat.outputs.size(), "output", "outputs")));
  print("ok: all names, wires, units and ranges are right\n");
  return ExitStatus::done;
}

std::string describe(const Mechanism& mechanism, const Group& group) {
  if (const auto* const crank = std::get_if<CrankGroup>(&group)) {
    return fmt::format("crank {}: turns about {} with drive '{}'", crank->name,
                       mechanism.points[crank->pivot].name, mechanism.drives[crank->drive].name);
  }
  const auto& dyad = std::get<DyadGroup>(group);
  return fmt::format("dyad {} (class II, RRR): {} lies {} of {} → {}", dyad.name,
                     mechanism.points[dyad.c].name, dyad.side > 0 ? "left" : "right",
                     mechanism.points[dyad.p].name, mechanism.points[dyad.q].name);
}

ExitStatus check_mechanism(const std::string& path, const std::string& text) {
  const Mechanism mechanism = parse_mechanism(text, path);
  const Structure structure = decompose(mechanism);
  const bool moves = !mechanism.drives.empty();
  const auto obstacle = moves ? find_obstacle(mechanism, structure) : std::nullopt;
  print(fmt::format("{}: a mechanism, \"{}\"\n", path, mechanism.title));
  print(fmt::format("  {}, mobility {}, {}\n", count(mechanism.bodies.size(), "body", "bodies"),
                    mobility(mechanism), count(mechanism.drives.size(), "drive", "drives")));
  for (const Group& group : structure.groups) print(fmt::format("  {}\n", describe(mechanism, group)));
  if (obstacle) {
    print(fmt::format(
        "no: over one turn the group {} {} at t = {:.6g} s\n", group_name(structure.groups[obstacle->group]),
        obstacle->status == oblique::Status::open ? "cannot be assembled" : "passes a dead centre",
        obstacle->time));
    return ExitStatus::no;
  }
  print(moves ? "ok: it can be assembled over the whole turn, without dead centres\n"
              : "ok: a structure, which can be assembled and does not move\n");
  return ExitStatus::done;
}

}  // namespace

ExitStatus check_file(const Session& session, const CheckRequest& request) {
  const std::string text = read_file(request.file);  // once: it may be a pipe
  const Document document = parse_document(text, request.file);
  const Value* const format = document.root.find("format");
  const std::string name = format != nullptr ? format->text : "";
  if (name == "oblique-diagram/1") return check_diagram(session, request.file, text);
  if (name == "oblique-mechanism/1") return check_mechanism(request.file, text);
  throw ReadError(
      Diagnostic{{request.file, {1, 1}},
                 "this is neither a diagram nor a mechanism",
                 R"(format = "oblique-diagram/1" or "oblique-mechanism/1" at the head of the file)",
                 {}});
}

}  // namespace oblique::cli
