// SPDX-License-Identifier: MIT
#include "studio/engine/description.h"

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/file_kind.h>

#include "studio/engine/lesson.h"

namespace oblique::studio {
namespace {

Json diagram_description(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  const network::Program program(network::assemble(flat));
  Json json;
  json["kind"] = "diagram";
  json["title"] = diagram.title;
  json["until"] = diagram.run.until;
  json["machine"] = diagram.machine.profile;
  json["blocks"] = Json::array();
  for (const diagram::BlockInstance& block : diagram.blocks)
    json["blocks"].push_back({{"name", block.name}, {"type", block.type}});
  json["outputs"] = Json::array();
  for (const diagram::FlatOutput& output : flat.outputs)
    json["outputs"].push_back({{"name", output.name}, {"unit", output.unit}});
  json["signals"] = program.signal_names();
  json["lesson"] = diagram.lesson ? lesson_of(*diagram.lesson) : Json();
  return json;
}

Json mechanism_description(const mechanism::Mechanism& mechanism) {
  Json json;
  json["kind"] = "mechanism";
  json["title"] = mechanism.title;
  json["unit"] = mechanism.length_unit;
  json["points"] = mechanism::names_of(mechanism.points);
  json["bodies"] = mechanism::names_of(mechanism.bodies);
  json["drives"] = Json::array();
  for (const mechanism::Drive& drive : mechanism.drives)
    json["drives"].push_back({{"name", drive.name}, {"slide", drive.slide.has_value()}});
  json["groups"] = Json::array();
  if (mechanism.drives.empty()) return json;  // a structure, which nothing moves
  for (const mechanism::Group& group : mechanism::decompose(mechanism).groups)
    json["groups"].push_back({{"name", group.name}, {"class", group.assur_class}});
  return json;
}

}  // namespace

Json description_of(const std::string& text, const std::string& name, const diagram::BlockLibrary& library) {
  return report::kind_of_file(text, name) == report::FileKind::diagram
             ? diagram_description(diagram::parse_diagram(text, name), library)
             : mechanism_description(mechanism::parse_mechanism(text, name));
}

}  // namespace oblique::studio
