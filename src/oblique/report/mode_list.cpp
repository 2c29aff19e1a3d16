// SPDX-License-Identifier: MIT
#include <oblique/report/mode_list.h>

#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/follower.h>

#include <oblique/mechanism/structure/structure.h>
#include <oblique/report/json_text.h>
#include <oblique/report/text_table.h>

namespace oblique::report {

ModesAt modes_at(const mechanism::Mechanism& mechanism, mechanism::Structure& structure, double time) {
  ModesAt position;
  position.undecided = mechanism::choose_some_modes(mechanism, structure);
  mechanism::Follower follower(mechanism, structure);
  const mechanism::Configuration here = follower.advance(time);
  mechanism::DriveClock clock(mechanism);
  position.drives.resize(mechanism.drives.size());
  clock.at(time, position.drives);
  position.open = here.status == oblique::mechanism::Status::open;
  position.groups = mechanism::assembly_modes(mechanism, structure, position.drives, here);
  for (const std::size_t g : position.undecided) {
    for (mechanism::AssemblyMode& mode : position.groups[g].modes) mode.selected = false;
  }
  return position;
}

std::string to_text(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                    const ModesAt& position) {
  std::string text;
  for (std::size_t d = 0; d < position.drives.size(); ++d) {
    const mechanism::Drive& drive = mechanism.drives[d];
    const double value = position.drives[d].value;
    text += drive.slide ? fmt::format("{} = {:.6g} {}\n", drive.name, value, mechanism.length_unit)
                        : fmt::format("{} = {:.6g} deg\n", drive.name, value * 180 / std::numbers::pi);
  }
  for (const mechanism::GroupModes& group : position.groups) {
    const mechanism::Group& about = structure.groups[group.group];
    if (about.assur_class < 2) continue;
    text += fmt::format("\n{} (class {}): {}{}\n", about.name, about.assur_class,
                        group.complete ? "" : "at least ", count(group.modes.size(), "mode", "modes"));
    if (group.modes.empty()) continue;
    std::vector<std::string> header{""};
    for (const std::size_t point : group.modes.front().points) {
      header.push_back(mechanism.points[point].name + ".x");
      header.push_back(mechanism.points[point].name + ".y");
    }
    Table table(header);
    for (const mechanism::AssemblyMode& mode : group.modes) {
      std::vector<std::string> cells{mode.selected ? "selected" : ""};
      for (const Eigen::Vector2d& at : mode.positions) {
        cells.push_back(short_number(at.x(), mechanism.largest_length()));
        cells.push_back(short_number(at.y(), mechanism.largest_length()));
      }
      table.add(cells);
    }
    text += table.text(1);
  }
  return text;
}

std::string to_json(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                    const ModesAt& position) {
  nlohmann::ordered_json drives = nlohmann::ordered_json::object();
  for (std::size_t d = 0; d < position.drives.size(); ++d)
    drives[mechanism.drives[d].name] = position.drives[d].value;
  nlohmann::ordered_json groups = nlohmann::ordered_json::array();
  for (const mechanism::GroupModes& group : position.groups) {
    const mechanism::Group& about = structure.groups[group.group];
    nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
    for (const std::size_t body : about.bodies) bodies.push_back(mechanism.bodies[body].name);
    nlohmann::ordered_json modes = nlohmann::ordered_json::array();
    for (const mechanism::AssemblyMode& mode : group.modes) {
      nlohmann::ordered_json points = nlohmann::ordered_json::object();
      for (std::size_t i = 0; i < mode.points.size(); ++i)
        points[mechanism.points[mode.points[i]].name] = {mode.positions[i].x(), mode.positions[i].y()};
      modes.push_back({{"points", points}, {"selected", mode.selected}});
    }
    groups.push_back({{"name", about.name},
                      {"class", about.assur_class},
                      {"bodies", bodies},
                      {"complete", group.complete},
                      {"modes", modes}});
  }
  return json_text({{"drives", drives}, {"groups", groups}});
}

}  // namespace oblique::report
