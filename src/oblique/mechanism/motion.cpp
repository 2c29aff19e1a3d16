// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace oblique {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

[[noreturn]] void refuse(const Mechanism& mechanism, std::string what, std::string expected,
                         std::string remedy) {
  Diagnostic finding;
  finding.place = mechanism.drives.empty() ? Place{mechanism.file, {}} : mechanism.drives.front().place;
  finding.what = std::move(what);
  finding.expected = std::move(expected);
  finding.remedy = std::move(remedy);
  throw MechanismError(MechanismError::Kind::request, std::move(finding));
}

const Drive& first_drive(const Mechanism& mechanism) {
  if (mechanism.drives.empty()) {
    refuse(mechanism, "the mechanism has no drive and does not move", "[drives]",
           R"(turn a link: crank = { turns = "AB", about = "A", speed = "1 rad/s" })");
  }
  return mechanism.drives.front();
}

/// Longest time in which a limit is looked for: a turn, or for a slide the way of ten times the longest link.
double search_time(const Mechanism& mechanism) {
  const Drive& drive = first_drive(mechanism);
  if (!drive.slide) return period(mechanism);
  constexpr double kLongestWay = 10;
  return kLongestWay * mechanism.largest_length() / std::abs(drive.speed);
}

/// A time that goes to and fro between two limits, and in which direction it goes.
class Reversal {
 public:
  Reversal(double low, double high) : low_(low), high_(high) {}

  std::pair<double, double> at(double t) const {
    if (!std::isfinite(low_) && t <= high_) return {t, 1};
    const double width = high_ - low_;
    double phase = std::fmod(t - low_, 2 * width);
    if (phase < 0) phase += 2 * width;
    return phase <= width ? std::pair{low_ + phase, 1.0} : std::pair{high_ - (phase - width), -1.0};
  }

 private:
  double low_, high_;
};

/// The rates of a motion that goes backwards.
void turn_back(Configuration& configuration) {
  for (PointState& point : configuration.points) point.velocity = -point.velocity;
  for (BodyState& body : configuration.bodies) body.omega = -body.omega;
  for (SlideState& slide : configuration.slides) slide.velocity = -slide.velocity;
}

std::vector<double> spread(double end, int positions) {
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(positions));
  for (int k = 0; k < positions; ++k) times.push_back(end * k / (positions - 1));
  return times;
}

}  // namespace

double period(const Mechanism& mechanism) {
  const Drive& drive = first_drive(mechanism);
  if (mechanism.motion.until) return *mechanism.motion.until;
  if (drive.slide) {
    refuse(mechanism, fmt::format("drive '{}' moves a slide and makes no turn", drive.name),
           "a first drive that turns a body", "give the time of the motion: --until, or until in [motion]");
  }
  if (!drive.law) return kTurn / std::abs(drive.speed);
  // as long as ten turns at the speed of the start, or at the unit of the law
  const double speed = std::max(std::abs(drive.speed), drive.law_scale);
  if (const auto time = DriveClock(mechanism).time_of_way(0, kTurn, 10 * kTurn / speed)) return *time;
  refuse(mechanism,
         fmt::format("drive '{}' makes no full turn within {:.4g} s", drive.name, 10 * kTurn / speed),
         "a speed that turns it once", "give the time of the motion: --until, or until in [motion]");
}

double cycle(const Mechanism& mechanism, const Structure& structure) {
  const Drive& drive = first_drive(mechanism);
  if (!drive.slide || mechanism.motion.until) return period(mechanism);
  const MotionRange range = find_range(mechanism, structure);
  if (!range.backward || !range.forward) {
    refuse(mechanism, fmt::format("drive '{}' moves a slide that meets no limit", drive.name),
           "an end of the motion", "give its time: --until, or until in [motion]");
  }
  return 2 * (range.forward->time - range.backward->time);
}

void check_travel(const Mechanism& mechanism, double duration) {
  for (const Drive& drive : mechanism.drives) {
    const double turns =
        std::abs(drive.speed) * duration / (drive.slide ? mechanism.largest_length() : kTurn);
    if (turns <= kMostTurns) continue;
    throw MechanismError(
        MechanismError::Kind::request,
        Diagnostic{drive.place,
                   fmt::format("drive '{}' {} in the {:.6g} s of the motion", drive.name,
                               drive.slide ? fmt::format("goes {:.3g} times the longest link", turns)
                                           : fmt::format("turns {:.3g} times", turns),
                               duration),
                   drive.slide ? fmt::format("{:.0f} times at most", kMostTurns)
                               : fmt::format("{:.0f} turns of the fastest drive at most", kMostTurns),
                   "a motion lasts one turn of the first drive: put the fastest drive first in [drives], or "
                   "bring the speeds nearer to each other"});
  }
}

MotionRange find_range(const Mechanism& mechanism, const Structure& structure) {
  const double time = search_time(mechanism);
  check_travel(mechanism, time);
  MotionRange range;
  range.forward = Follower(mechanism, structure).advance_to_limit(time);
  range.backward = Follower(mechanism, structure).advance_to_limit(-time);
  return range;
}

Motion solve_motion(const Mechanism& mechanism, int positions) {
  MotionOptions options;
  options.positions = positions;
  return solve_motion(mechanism, options);
}

Motion solve_motion(const Mechanism& mechanism, const MotionOptions& options) {
  const Drive& drive = first_drive(mechanism);
  if (options.positions < 2) {
    Diagnostic finding;
    finding.what = fmt::format("a motion of {} positions", options.positions);
    finding.expected = "two positions or more";
    throw MechanismError(MechanismError::Kind::request, std::move(finding));
  }
  const Structure structure = decompose(mechanism);
  const auto until = options.until ? options.until : mechanism.motion.until;
  const AtLimit wanted = options.at_limit.value_or(mechanism.motion.at_limit.value_or(AtLimit::open));
  const bool to_and_fro = drive.slide && !until && wanted == AtLimit::open;
  const AtLimit at_limit = to_and_fro ? AtLimit::reverse : wanted;
  double end = until.value_or(0);
  if (at_limit == AtLimit::open) {
    if (!until) end = cycle(mechanism, structure);
    return solve_motion(mechanism, structure, spread(end, options.positions));
  }
  const MotionRange range = find_range(mechanism, structure);
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const double low = range.backward ? range.backward->time : -kEndless;
  const double high = range.forward ? range.forward->time : kEndless;
  if (!until)
    end = at_limit == AtLimit::stop && range.forward ? high
          : range.forward && range.backward          ? 2 * (high - low)
                                                     : cycle(mechanism, structure);
  if (at_limit == AtLimit::stop) {
    return solve_motion(mechanism, structure, spread(std::min(end, high), options.positions));
  }
  const Reversal reversal(low, high);
  std::vector<double> times = spread(end, options.positions);
  std::vector<double> directions(times.size(), 1);
  std::vector<double> mapped = times;
  if (range.forward) {
    for (std::size_t k = 0; k < times.size(); ++k) std::tie(mapped[k], directions[k]) = reversal.at(times[k]);
  }
  Motion motion = solve_motion(mechanism, structure, mapped);
  motion.times = std::move(times);
  for (std::size_t k = 0; k < directions.size(); ++k) {
    if (directions[k] > 0) continue;
    turn_back(motion.configurations[k]);
    for (DriveState& state : motion.drives[k]) state.rate = -state.rate;
  }
  return motion;
}

Motion solve_motion(const Mechanism& mechanism, std::span<const double> times) {
  return solve_motion(mechanism, decompose(mechanism), times);
}

Motion solve_motion(const Mechanism& mechanism, const Structure& structure, std::span<const double> times) {
  double duration = 0;
  for (std::size_t k = 1; k < times.size(); ++k) duration += std::abs(times[k] - times[k - 1]);
  check_travel(mechanism, duration);
  Motion motion;
  motion.times.assign(times.begin(), times.end());
  Follower follower(mechanism, structure);
  DriveClock clock(mechanism);
  for (const double t : times) {
    motion.configurations.push_back(follower.advance(t));
    motion.drives.emplace_back(mechanism.drives.size());
    clock.at(t, motion.drives.back());
  }
  motion.events = follower.events();
  return motion;
}

std::vector<MotionColumn> motion_columns(const Mechanism& mechanism, const Motion& motion) {
  const std::string& length = mechanism.length_unit;
  std::vector<MotionColumn> columns;
  const auto add = [&](std::string name, std::string unit, auto value_in_row) {
    MotionColumn column{std::move(name), std::move(unit), {}};
    for (std::size_t row = 0; row < motion.times.size(); ++row) column.values.push_back(value_in_row(row));
    columns.push_back(std::move(column));
  };
  add("t", "s", [&](std::size_t row) { return motion.times[row]; });
  for (std::size_t i = 0; i < mechanism.drives.size(); ++i) {
    add(mechanism.drives[i].name, mechanism.drives[i].slide ? length : "rad",
        [&](std::size_t row) { return motion.drives[row][i].value; });
  }
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    if (mechanism.points[i].fixed) continue;
    const std::string& name = mechanism.points[i].name;
    const auto add_vector = [&](const char* x, const char* y, const std::string& unit,
                                Eigen::Vector2d PointState::*part) {
      add(name + x, unit, [&](std::size_t row) { return (motion.configurations[row].points[i].*part).x(); });
      add(name + y, unit, [&](std::size_t row) { return (motion.configurations[row].points[i].*part).y(); });
    };
    add_vector(".x", ".y", length, &PointState::position);
    add_vector(".vx", ".vy", length + "/s", &PointState::velocity);
    add_vector(".ax", ".ay", length + "/s^2", &PointState::acceleration);
  }
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) {
    const std::string& name = mechanism.bodies[i].name;
    add(name + ".angle", "rad", [&](std::size_t row) { return motion.configurations[row].bodies[i].angle; });
    add(name + ".omega", "rad/s",
        [&](std::size_t row) { return motion.configurations[row].bodies[i].omega; });
    add(name + ".alpha", "rad/s^2",
        [&](std::size_t row) { return motion.configurations[row].bodies[i].alpha; });
  }
  for (std::size_t i = 0; i < mechanism.slides.size(); ++i) {
    const std::string& name = mechanism.slides[i].name;
    const auto add_part = [&](const char* part, const std::string& unit, double SlideState::*value) {
      add(name + part, unit,
          [&, value](std::size_t row) { return motion.configurations[row].slides[i].*value; });
    };
    add_part(".position", length, &SlideState::position);
    add_part(".velocity", length + "/s", &SlideState::velocity);
    add_part(".acceleration", length + "/s^2", &SlideState::acceleration);
  }
  return columns;
}

std::string motion_csv(const Mechanism& mechanism, const Motion& motion) {
  return motion_csv(motion_columns(mechanism, motion), motion);
}

std::string motion_csv(const std::vector<MotionColumn>& columns, const Motion& motion) {
  std::string text;
  for (const MotionColumn& column : columns) text += column.name + ",";
  text += "status\n";
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    for (const MotionColumn& column : columns) {
      if (!std::isnan(column.values[row])) fmt::format_to(std::back_inserter(text), "{}", column.values[row]);
      text += ",";
    }
    text += status_name(motion.configurations[row].status);
    text += "\n";
  }
  return text;
}

}  // namespace oblique
