// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <oblique/mechanism/model/plane.h>

namespace oblique::mechanism {
namespace {

[[noreturn]] void refuse(const Mechanism& mechanism, std::string what, std::string expected,
                         std::string remedy) {
  text::Diagnostic finding;
  finding.place = mechanism.drives.empty() ? text::Place{mechanism.file, {}} : mechanism.drives.front().place;
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

/// Longest time in which a limit is looked for: a turn, or for a prismatic joint the way of ten times the
/// longest link.
double search_time(const Mechanism& mechanism) {
  const Drive& drive = first_drive(mechanism);
  if (!drive.slide) return period(mechanism);
  constexpr double kLongestWay = 10;
  return kLongestWay * mechanism.largest_length() / std::abs(drive.speed);
}

/// Up to which time a motion goes that ends at a limit, or before infinity.
double end_of(const Mechanism& mechanism, const MotionEvent& end) {
  if (end.kind != MotionEvent::Kind::infinity) return end.time;
  double fastest = 0;
  for (const Drive& drive : mechanism.drives) {
    const double rate = std::abs(drive.speed);
    fastest = std::max(fastest, drive.slide ? rate / mechanism.largest_length() : rate);
  }
  return end.time - std::copysign(kBeforeInfinity / fastest, end.time);
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

}  // namespace

double period(const Mechanism& mechanism) {
  const Drive& drive = first_drive(mechanism);
  if (mechanism.motion.until) return *mechanism.motion.until;
  if (drive.slide) {
    refuse(mechanism, fmt::format("drive '{}' moves a slide and makes no turn", drive.name),
           "a first drive that turns a body", "give the time of the motion, until in [motion]");
  }
  if (!drive.law) return kTurn / std::abs(drive.speed);
  // as long as ten turns at the speed of the start, or at the unit of the law
  const double speed = std::max(std::abs(drive.speed), drive.law_scale);
  if (const auto time = DriveClock(mechanism).time_of_way(0, kTurn, 10 * kTurn / speed)) return *time;
  refuse(mechanism,
         fmt::format("drive '{}' makes no full turn within {:.4g} s", drive.name, 10 * kTurn / speed),
         "a speed that turns it once", "give the time of the motion, until in [motion]");
}

double cycle(const Mechanism& mechanism, const Structure& structure) {
  const Drive& drive = first_drive(mechanism);
  if (!drive.slide || mechanism.motion.until) return period(mechanism);
  const MotionLimits range = find_range(mechanism, structure);
  if (!range.backward || !range.forward) {
    refuse(mechanism, fmt::format("drive '{}' moves a slide that meets no limit", drive.name),
           "an end of the motion", "give its time, until in [motion]");
  }
  return 2 * (range.forward->time - range.backward->time);
}

namespace {

/// How often a drive turns in `duration`, or how many of the longest links it goes.
double turns_of(const Mechanism& mechanism, const Drive& drive, double duration) {
  return std::abs(drive.speed) * duration / (drive.slide ? mechanism.largest_length() : kTurn);
}

}  // namespace

int rows_over_motion(const Mechanism& mechanism, int over_a_turn, int most) {
  constexpr double kWhole = 1e-6;  // of a turn
  double turns = 1;
  const bool is_known =
      mechanism.motion.until || (!mechanism.drives.empty() && !mechanism.drives.front().slide);
  for (const Drive& drive : mechanism.drives) {
    if (is_known) turns = std::max(turns, std::ceil(turns_of(mechanism, drive, period(mechanism)) - kWhole));
  }
  const int least = over_a_turn - 1;
  return 1 + std::max(least, static_cast<int>(std::min<double>(least * turns, most)));
}

void check_travel(const Mechanism& mechanism, double duration) {
  for (const Drive& drive : mechanism.drives) {
    const double turns = turns_of(mechanism, drive, duration);
    if (turns <= kMostTurns) continue;
    throw MechanismError(
        MechanismError::Kind::request,
        text::Diagnostic{
            drive.place,
            fmt::format("drive '{}' {} in the {:.6g} s of the motion", drive.name,
                        drive.slide ? fmt::format("goes {:.3g} times the longest link", turns)
                                    : fmt::format("turns {:.3g} times", turns),
                        duration),
            drive.slide ? fmt::format("{:.0f} times at most", kMostTurns)
                        : fmt::format("{:.0f} turns of the fastest drive at most", kMostTurns),
            mechanism.drives.size() == 1
                ? "let the motion end earlier, until in [motion]"
                : "a motion lasts one turn of the first drive: put the fastest drive first in [drives], "
                  "bring the speeds nearer to each other, or let the motion end earlier, until in [motion]"});
  }
}

MotionLimits find_range(const Mechanism& mechanism, const Structure& structure) {
  const double time = search_time(mechanism);
  check_travel(mechanism, time);
  MotionLimits range;
  range.forward = Follower(mechanism, structure).advance_to_limit(time);
  range.backward = Follower(mechanism, structure).advance_to_limit(-time);
  return range;
}

namespace {

/// Refuses a drive that is to run back to where its law has no value: no limit is there to turn it round.
void check_law_behind(const Mechanism& mechanism, double low, double high) {
  constexpr double kBehind = 1e-6;  // of the time between the limits
  for (const Drive& drive : mechanism.drives) {
    if (std::isfinite(law_at(drive, low - kBehind * (high - low)).rate)) continue;
    throw MechanismError(
        MechanismError::Kind::request,
        text::Diagnostic{
            drive.place,
            fmt::format("the speed of drive '{}' has no value before t = {:.6g} s, and from its limit the "
                        "drive runs back in time, farther than that",
                        drive.name, low),
            "a law that has values back to the other limit",
            "let it stop there, at_limit = \"stop\" in [motion], or write the law so that it goes on before "
            "that"});
  }
}

}  // namespace

std::optional<double> time_at_value(const Mechanism& mechanism, double value) {
  const Drive& drive = first_drive(mechanism);
  double way = value - drive.start;
  constexpr double kSame = 1e-12;
  if (std::abs(way) < kSame) return 0;
  if (!drive.slide && way * drive.speed < 0) {
    way += std::copysign(kTurn * std::ceil(std::abs(way) / kTurn), drive.speed);
  }
  if (way * drive.speed < 0) return std::nullopt;
  constexpr double kLatest = 100;
  const double turn = drive.slide ? mechanism.largest_length() : kTurn;
  return DriveClock(mechanism).time_of_way(0, way, kLatest * turn / std::abs(drive.speed));
}

std::vector<MotionEvent> visit_motion(const Mechanism& mechanism, const Structure& structure,
                                      const MotionOptions& options,
                                      const std::function<void(const MotionRow&)>& visit) {
  const Drive& drive = first_drive(mechanism);
  if (options.positions < 2) {
    text::Diagnostic finding;
    finding.what = fmt::format("a motion of {} positions", options.positions);
    finding.expected = "two positions or more";
    throw MechanismError(MechanismError::Kind::request, std::move(finding));
  }
  const auto until = options.until ? options.until : mechanism.motion.until;
  AtLimit at_limit = options.at_limit.value_or(mechanism.motion.at_limit.value_or(AtLimit::open));
  if (drive.slide && !until && at_limit == AtLimit::open) at_limit = AtLimit::reverse;
  MotionLimits range;
  if (at_limit != AtLimit::open) range = find_range(mechanism, structure);
  const double high = range.forward ? end_of(mechanism, *range.forward) : 0;
  const double low =
      range.backward ? end_of(mechanism, *range.backward) : -std::numeric_limits<double>::infinity();
  double end = 0;
  if (until) {
    end = *until;
  } else if (at_limit == AtLimit::reverse && range.forward && range.backward) {
    end = 2 * (high - low);
  } else if (at_limit != AtLimit::stop || !range.forward) {
    end = cycle(mechanism, structure);
  }
  if (at_limit == AtLimit::stop && range.forward) end = until ? std::min(*until, high) : high;
  check_travel(mechanism, end);

  Follower follower(mechanism, structure);
  DriveClock clock(mechanism);
  std::vector<DriveState> drives(mechanism.drives.size());
  Configuration backwards;
  const Reversal reversal(low, high);
  if (at_limit == AtLimit::reverse && range.backward && end > high + (high - low))
    check_law_behind(mechanism, low, high);
  for (int k = 0; k < options.positions; ++k) {
    const double time = end * k / (options.positions - 1);
    double there = time, direction = 1;
    if (at_limit == AtLimit::reverse && range.forward) std::tie(there, direction) = reversal.at(time);
    const Configuration* here = &follower.advance(there);
    clock.at(there, drives);
    if (direction < 0) {
      backwards = *here;
      turn_back(backwards);
      for (DriveState& state : drives) state.rate = -state.rate;
      here = &backwards;
    }
    visit({time, drives, *here});
  }
  return follower.events();
}

Motion solve_motion(const Mechanism& mechanism, int positions) {
  MotionOptions options;
  options.positions = positions;
  return solve_motion(mechanism, options);
}

Motion solve_motion(const Mechanism& mechanism, const MotionOptions& options) {
  Motion motion;
  motion.events = visit_motion(mechanism, decompose(mechanism), options, [&](const MotionRow& row) {
    motion.times.push_back(row.time);
    motion.drives.emplace_back(row.drives.begin(), row.drives.end());
    motion.configurations.push_back(row.configuration);
  });
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

std::vector<MotionColumnName> motion_column_names(const Mechanism& mechanism) {
  const std::string& length = mechanism.length_unit;
  std::vector<MotionColumnName> columns{{"t", "s"}};
  for (const Drive& drive : mechanism.drives) columns.push_back({drive.name, drive.slide ? length : "rad"});
  for (const Point& point : mechanism.points) {
    if (point.fixed) continue;
    for (const auto& [part, unit] : {std::pair{"", ""}, std::pair{"v", "/s"}, std::pair{"a", "/s^2"}}) {
      columns.push_back({point.name + "." + part + "x", length + unit});
      columns.push_back({point.name + "." + part + "y", length + unit});
    }
  }
  for (const Body& body : mechanism.bodies) {
    columns.push_back({body.name + ".angle", "rad"});
    columns.push_back({body.name + ".omega", "rad/s"});
    columns.push_back({body.name + ".alpha", "rad/s^2"});
  }
  for (const Slide& slide : mechanism.slides) {
    columns.push_back({slide.name + ".position", length});
    columns.push_back({slide.name + ".velocity", length + "/s"});
    columns.push_back({slide.name + ".acceleration", length + "/s^2"});
  }
  return columns;
}

void motion_values(const Mechanism& mechanism, const MotionRow& row, std::span<double> values) {
  std::size_t k = 0;
  values[k++] = row.time;
  for (const DriveState& drive : row.drives) values[k++] = drive.value;
  const Configuration& here = row.configuration;
  for (std::size_t i = 0; i < here.points.size(); ++i) {
    if (mechanism.points[i].fixed) continue;
    const PointState& point = here.points[i];
    for (const Eigen::Vector2d* part : {&point.position, &point.velocity, &point.acceleration}) {
      values[k++] = part->x();
      values[k++] = part->y();
    }
  }
  for (const BodyState& body : here.bodies) {
    values[k++] = body.angle;
    values[k++] = body.omega;
    values[k++] = body.alpha;
  }
  for (const SlideState& slide : here.slides) {
    values[k++] = slide.position;
    values[k++] = slide.velocity;
    values[k++] = slide.acceleration;
  }
}

std::vector<MotionColumn> motion_columns(const Mechanism& mechanism, const Motion& motion) {
  std::vector<MotionColumn> columns;
  for (MotionColumnName& column : motion_column_names(mechanism)) {
    columns.push_back({std::move(column.name), std::move(column.unit), {}});
    columns.back().values.reserve(motion.times.size());
  }
  std::vector<double> values(columns.size());
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    motion_values(mechanism, {motion.times[row], motion.drives[row], motion.configurations[row]}, values);
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].values.push_back(values[c]);
  }
  return columns;
}

}  // namespace oblique::mechanism
