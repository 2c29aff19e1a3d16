// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/solver/assembly.h>

#include "command.h"
#include "drive_place.h"
#include "json_text.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

/// A mechanism at one position of its drives, with what can be put together there.
struct Position {
  std::vector<mechanism::DriveState> drives;
  bool open = false;
  std::vector<std::size_t> undecided;  ///< groups for which the sketch picks no mode
  std::vector<mechanism::GroupModes> groups;
};

Position position_of(const mechanism::Mechanism& mechanism, mechanism::Structure& structure,
                     const ModesRequest& request) {
  Position position;
  position.undecided = mechanism::choose_some_modes(mechanism, structure);
  const double time = time_option_at(mechanism, request.at);
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

std::string text_of(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                    const Position& position) {
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

std::string json_of(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                    const Position& position) {
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

}  // namespace

ExitStatus show_modes(const Session&, const ModesRequest& request) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(request.mechanism);
  mechanism::Structure structure = mechanism::find_groups(mechanism);
  const Position position = position_of(mechanism, structure, request);
  print((request.json ? json_of : text_of)(mechanism, structure, position));
  for (const std::size_t g : position.undecided) {
    note(fmt::format(
        "the sketch picks no mode of {}: sketch one of its points as it lies in the mode you want\n",
        structure.groups[g].name));
  }
  if (!position.open) return ExitStatus::done;
  note("the mechanism cannot be assembled there\n");
  return ExitStatus::no;
}

}  // namespace oblique::cli
