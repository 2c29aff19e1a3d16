// SPDX-License-Identifier: MIT
#include "linkage_scene.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/follower.h>
#include <oblique/mechanism/motion.h>

#include "drive_place.h"

namespace oblique::cli {
namespace {

constexpr int kRows = 721;  // of a path: a moment in every half degree of the crank

std::size_t point_named(const Mechanism& mechanism, const std::string& option, const std::string& name) {
  if (const auto point = mechanism.find_point(name)) return *point;
  throw ReadError(Diagnostic{{mechanism.file, {}},
                             fmt::format("{}: there is no point '{}'", option, name),
                             {},
                             suggest(name, names_of(mechanism.points))});
}

/// The positions beside the one that is shown, the last one just before it.
std::vector<Configuration> other_positions(const Mechanism& mechanism, const Structure& structure,
                                           const DrawnMotion& motion, double shown, int positions) {
  if (positions < 2) return {};
  if (!motion.closed) return drawn_motion(mechanism, structure, positions - 1).rows;
  const double turn = motion.times.back() - motion.times.front();
  std::vector<double> times;
  for (int k = 1; k < positions; ++k) times.push_back(shown + turn * k / positions);
  return solve_motion(mechanism, structure, times).configurations;
}

}  // namespace

DrawnMotion drawn_motion(const Mechanism& mechanism, const Structure& structure, int rows) {
  DrawnMotion motion;
  TourWalk walk(mechanism, structure, plan_tour(mechanism, structure));
  motion.closed = walk.tour().closed;
  for (int k = 0; k < rows; ++k) {
    motion.rows.push_back(walk.go(rows == 1 ? 0.0 : static_cast<double>(k) / (rows - 1)));
    motion.times.push_back(walk.time());
  }
  return motion;
}

std::vector<std::size_t> trace_option(const Mechanism& mechanism, const std::vector<std::string>& names) {
  if (names.empty()) return points_to_trace(mechanism);
  if (names.size() == 1 && names.front() == "none" && !mechanism.find_point("none")) return {};
  std::vector<std::size_t> points;
  for (const std::string& name : names) points.push_back(point_named(mechanism, "--trace", name));
  return points;
}

LinkageScene linkage_scene(const Mechanism& mechanism, const std::string& at, int positions) {
  LinkageScene scene;
  const double time = time_option_at(mechanism, at);
  const Structure structure = decompose(mechanism);
  Follower follower(mechanism, structure);
  scene.shown = follower.advance(time);
  if (!mechanism.drives.empty()) scene.caption = drive_caption(mechanism, time);
  if (scene.shown.status == oblique::Status::open) {
    throw MechanismError(
        MechanismError::Kind::assembly,
        Diagnostic{{mechanism.file, {}},
                   fmt::format("the mechanism cannot be assembled at {}", scene.caption),
                   {},
                   fmt::format("'oblique check {}' says how far it can go", mechanism.file)});
  }
  if (mechanism.drives.empty()) return scene;
  DrawnMotion motion = drawn_motion(mechanism, structure, kRows);
  scene.others = other_positions(mechanism, structure, motion, time, positions);
  scene.motion = std::move(motion.rows);
  return scene;
}

PointHistory point_history(const Mechanism& mechanism, const std::string& point) {
  const std::size_t index = point_named(mechanism, "--plots", point);
  if (mechanism.drives.empty()) period(mechanism);  // says that there is no drive
  const Structure structure = decompose(mechanism);
  const DrawnMotion motion = drawn_motion(mechanism, structure, kRows);
  const Drive& drive = mechanism.drives.front();
  PointHistory history;
  history.title = mechanism.title;
  history.point = point;
  history.length_unit = mechanism.length_unit;
  history.drive = drive.name;
  history.drive_unit = drive.slide ? mechanism.length_unit : "°";
  DriveClock clock(mechanism);
  for (std::size_t k = 0; k < motion.rows.size(); ++k) {
    const double value = clock.at(0, motion.times[k]).value;
    history.drives.push_back(drive.slide ? value : value * 180 / std::numbers::pi);
    history.states.push_back(motion.rows[k].points[index]);
  }
  return history;
}

}  // namespace oblique::cli
