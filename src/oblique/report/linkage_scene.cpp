// SPDX-License-Identifier: MIT
#include <oblique/report/linkage_scene.h>

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/motion/motion_range.h>

#include <oblique/mechanism/structure/structure.h>
#include <oblique/report/drive_caption.h>

namespace oblique::report {
namespace {

constexpr int kRows = 721;  // of a path: a moment in every half degree of the crank

std::size_t point_named(const mechanism::Mechanism& mechanism, const std::string& setting,
                        const std::string& name) {
  if (const auto point = mechanism.find_point(name)) return *point;
  throw text::ReadError(text::Diagnostic{{mechanism.file, {}, {setting}},
                                         fmt::format("there is no point '{}'", name),
                                         {},
                                         text::suggest(name, mechanism::names_of(mechanism.points))});
}

/// Whether all points lie where they lay, to what can be seen.
bool same_place(const mechanism::Configuration& one, const mechanism::Configuration& other, double size) {
  constexpr double kSeen = 1e-6;
  for (std::size_t p = 0; p < one.points.size(); ++p) {
    if (!((one.points[p].position - other.points[p].position).norm() <= kSeen * size)) return false;
  }
  return true;
}

/// Whether a motion meets a limit at which its drives do not turn back, be it between two of its rows.
bool ends_at_limit(const mechanism::Mechanism& mechanism, const mechanism::Motion& motion) {
  const mechanism::AtLimit way_on = mechanism.motion.at_limit.value_or(
      mechanism.drives.front().slide ? mechanism::AtLimit::reverse : mechanism::AtLimit::open);
  return way_on == mechanism::AtLimit::open &&
         std::any_of(motion.events.begin(), motion.events.end(),
                     [](const mechanism::MotionEvent& event) { return event.ends(); });
}

/// The positions beside the one that is shown, the last one just before it.
std::vector<mechanism::Configuration> other_positions(const mechanism::Mechanism& mechanism,
                                                      const mechanism::Structure& structure,
                                                      const DrawnMotion& motion, double shown,
                                                      int positions) {
  if (positions < 2) return {};
  if (!motion.closed) {
    std::vector<mechanism::Configuration> rows = drawn_motion(mechanism, structure, positions - 1).rows;
    rows.resize(static_cast<std::size_t>(positions - 1));
    return rows;
  }
  const double turn = motion.times.back() - motion.times.front();
  std::vector<double> times;
  for (int k = 1; k < positions; ++k) times.push_back(shown + turn * k / positions);
  return mechanism::solve_motion(mechanism, structure, times).configurations;
}

}  // namespace

DrawnMotion drawn_motion(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                         int rows) {
  mechanism::MotionOptions options;
  options.positions = std::max(2, rows);
  mechanism::Motion whole = mechanism::solve_motion(mechanism, options);
  if (!ends_at_limit(mechanism, whole)) {
    const bool closed =
        same_place(whole.configurations.front(), whole.configurations.back(), mechanism.largest_length());
    return {std::move(whole.configurations), std::move(whole.times), closed, false};
  }
  const mechanism::MotionRange motion_range = mechanism::plan_motion_range(mechanism, structure);
  constexpr double kBesideLimit = 1e-5;  // where the mechanism can surely be assembled
  const double first = motion_range.from_limit ? kBesideLimit : 0, last = 1 - kBesideLimit;
  DrawnMotion motion;
  motion.ends_at_limit = true;
  motion.times.reserve(static_cast<std::size_t>(options.positions));
  for (int k = 0; k < options.positions; ++k)
    motion.times.push_back(motion_range.time(first + (last - first) * k / (options.positions - 1)));
  motion.rows = mechanism::solve_motion(mechanism, structure, motion.times).configurations;
  return motion;
}

DrawnMotion drawn_round(const mechanism::Mechanism& mechanism, int frames) {
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  DrawnMotion motion = drawn_motion(mechanism, structure, frames + 1);
  if (!motion.closed) motion = drawn_motion(mechanism, structure, (frames + 1) / 2 + 1);
  DrawnMotion round;
  round.closed = motion.closed;
  round.ends_at_limit = motion.ends_at_limit;
  const auto add = [&](std::size_t k, bool back) {
    if (motion.rows[k].status == mechanism::Status::open) return;
    round.rows.push_back(motion.rows[k]);
    if (back) mechanism::turn_back(round.rows.back());
    round.times.push_back(motion.times[k]);
  };
  for (std::size_t k = 0; k < motion.rows.size(); ++k) add(k, false);
  if (motion.closed) return round;
  for (std::size_t k = motion.rows.size() - 1; k-- > 0;) add(k, true);
  return round;
}

std::vector<std::size_t> traced_points(const mechanism::Mechanism& mechanism,
                                       const std::vector<std::string>& names) {
  if (names.empty()) return draw::points_to_trace(mechanism);
  if (names.size() == 1 && names.front() == "none" && !mechanism.find_point("none")) return {};
  std::vector<std::size_t> points;
  points.reserve(names.size());
  for (const std::string& name : names) points.push_back(point_named(mechanism, "trace", name));
  return points;
}

TimedScene linkage_scene(const mechanism::Mechanism& mechanism, double time, int positions) {
  TimedScene timed;
  draw::LinkageScene& scene = timed.scene;
  timed.time = time;
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  mechanism::Follower follower(mechanism, structure);
  scene.shown = follower.advance(time);
  if (!mechanism.drives.empty()) scene.caption = drive_caption(mechanism, time);
  if (scene.shown.status == oblique::mechanism::Status::open) {
    throw mechanism::MechanismError(
        mechanism::MechanismError::Kind::assembly,
        text::Diagnostic{{mechanism.file, {}},
                         fmt::format("the mechanism cannot be assembled at {}", scene.caption),
                         {},
                         {text::Action{"check", mechanism.file}, " says how far it can go"}});
  }
  if (mechanism.drives.empty()) return timed;
  DrawnMotion motion = drawn_motion(mechanism, structure, kRows);
  scene.others = other_positions(mechanism, structure, motion, time, positions);
  scene.motion = std::move(motion.rows);
  timed.times = std::move(motion.times);
  return timed;
}

draw::PointHistory point_history(const mechanism::Mechanism& mechanism, const std::string& point) {
  const std::size_t index = point_named(mechanism, "plots", point);
  if (mechanism.drives.empty()) mechanism::period(mechanism);  // says that there is no drive
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  const DrawnMotion motion = drawn_motion(mechanism, structure, kRows);
  const mechanism::Drive& drive = mechanism.drives.front();
  draw::PointHistory history;
  history.title = mechanism.title;
  history.point = point;
  history.length_unit = mechanism.length_unit;
  history.drive = drive.name;
  history.ends_at_limit = motion.ends_at_limit;
  history.drive_unit = drive.slide ? mechanism.length_unit : "°";
  history.size = mechanism.largest_length();
  history.rate = 2 * std::numbers::pi / (motion.times.back() - motion.times.front());
  mechanism::DriveClock clock(mechanism);
  for (std::size_t k = 0; k < motion.rows.size(); ++k) {
    const double value = clock.at(0, motion.times[k]).value;
    history.drives.push_back(drive.slide ? value : value * 180 / std::numbers::pi);
    history.states.push_back(motion.rows[k].points[index]);
  }
  return history;
}

}  // namespace oblique::report
