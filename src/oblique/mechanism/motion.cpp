// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace oblique {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Largest turn of a drive between two positions through which the bodies' angles are followed.
constexpr double kDriveStep = std::numbers::pi / 180;
/// Largest turn of a body between two such positions; a larger one halves the step.
constexpr double kBodyStep = std::numbers::pi / 6;
/// Halvings of a step: beyond them a turn is a jump (P passing over Q), not a motion.
constexpr int kMostHalvings = 30;

/// Follows the angles of bodies from one time to the next. An angle known up to whole turns is continued by
/// the turn nearest to the last one, which is right as long as no body turns by half a turn in a step; steps
/// are made so small that none turns by more than kBodyStep.
class AngleTracker {
 public:
  AngleTracker(const Mechanism& mechanism, const Structure& structure)
      : mechanism_(mechanism), structure_(structure) {
    for (const Drive& drive : mechanism.drives) fastest_ = std::max(fastest_, std::abs(drive.speed));
  }

  /// The configuration at time `t`, its angles continuous with those of the call before.
  Configuration advance(double t) {
    const double begin = started_ ? time_ : t;
    const auto steps = static_cast<long>(std::ceil(fastest_ * std::abs(t - begin) / kDriveStep));
    for (long i = 1; i < steps; ++i) {
      step_to(begin + (t - begin) * (static_cast<double>(i) / static_cast<double>(steps)), kMostHalvings);
    }
    started_ = true;
    return step_to(t, kMostHalvings);
  }

 private:
  Configuration step_to(double t, int halvings) {
    Configuration next = solve_configuration(mechanism_, structure_, drive_angles(mechanism_, t));
    if (next.status != Status::open) {
      if (!angles_.empty() && halvings > 0 && t != time_ && largest_turn(next) > kBodyStep) {
        step_to(time_ + (t - time_) / 2, halvings - 1);
        return step_to(t, halvings - 1);
      }
      unwrap(next);
    }
    time_ = t;
    return next;
  }

  double largest_turn(const Configuration& next) const {
    double largest = 0;
    for (std::size_t i = 0; i < angles_.size(); ++i) {
      if (!mechanism_.drive_of(i)) {
        largest = std::max(largest, std::abs(std::remainder(next.bodies[i].angle - angles_[i], kTurn)));
      }
    }
    return largest;
  }

  void unwrap(Configuration& next) {
    const bool first = angles_.empty();
    angles_.resize(next.bodies.size());
    for (std::size_t i = 0; i < angles_.size(); ++i) {
      double& angle = next.bodies[i].angle;
      if (!first && !mechanism_.drive_of(i)) angle += kTurn * std::round((angles_[i] - angle) / kTurn);
      angles_[i] = angle;
    }
  }

  const Mechanism& mechanism_;
  const Structure& structure_;
  double fastest_ = 0;  ///< [rad/s]
  bool started_ = false;
  double time_ = 0;
  std::vector<double> angles_;  ///< of the last configuration that was not open
};

}  // namespace

double period(const Mechanism& mechanism) {
  if (mechanism.drives.empty()) {
    Diagnostic finding;
    finding.place.file = mechanism.file;
    finding.what = "the mechanism has no drive and does not move";
    finding.expected = "[drives]";
    finding.remedy = R"(turn a link: crank = { turns = "AB", about = "A", speed = "1 rad/s" })";
    throw MechanismError(MechanismError::Kind::request, std::move(finding));
  }
  return kTurn / std::abs(mechanism.drives.front().speed);
}

void check_travel(const Mechanism& mechanism, double duration) {
  for (const Drive& drive : mechanism.drives) {
    const double turns = std::abs(drive.speed) * duration / kTurn;
    if (turns <= kMostTurns) continue;
    throw MechanismError(
        MechanismError::Kind::request,
        Diagnostic{drive.place,
                   fmt::format("drive '{}' turns {:.3g} times in the {:.6g} s of the motion", drive.name,
                               turns, duration),
                   fmt::format("{:.0f} turns of the fastest drive at most", kMostTurns),
                   "a motion lasts one turn of the first drive: put the fastest drive first in [drives], or "
                   "bring the speeds nearer to each other"});
  }
}

Motion solve_motion(const Mechanism& mechanism, int positions) {
  const double turn = period(mechanism);
  if (positions < 2) {
    Diagnostic finding;
    finding.what = fmt::format("a motion of {} positions", positions);
    finding.expected = "two positions or more";
    throw MechanismError(MechanismError::Kind::request, std::move(finding));
  }
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(positions));
  for (int k = 0; k < positions; ++k) times.push_back(turn * k / (positions - 1));
  return solve_motion(mechanism, times);
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
  AngleTracker tracker(mechanism, structure);
  for (const double t : times) {
    motion.drive_angles.push_back(drive_angles(mechanism, t));
    motion.configurations.push_back(tracker.advance(t));
  }
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
    add(mechanism.drives[i].name, "rad", [&](std::size_t row) { return motion.drive_angles[row][i]; });
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
  return columns;
}

std::string motion_csv(const Mechanism& mechanism, const Motion& motion) {
  const std::vector<MotionColumn> columns = motion_columns(mechanism, motion);
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
