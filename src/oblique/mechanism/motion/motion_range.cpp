// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion_range.h>
#include <oblique/mechanism/structure/structure.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace oblique::mechanism {
namespace {

/// Way of a drive [rad] in an interval of the samples.
constexpr double kSampleStep = std::numbers::pi / 720;
constexpr std::size_t kFewestSamples = 1440, kMostSamples = 20000;
/// Limits are known to about 1e-11 rad of the fastest drive; a motion range keeps this far away from them
/// [rad].
constexpr double kBeforeLimit = 4e-11;

double fastest_rate(const Mechanism& mechanism) {
  double fastest = 0;
  for (const Drive& drive : mechanism.drives) {
    const double rate = std::abs(drive.speed);
    fastest = std::max(fastest, drive.slide ? rate / mechanism.largest_length() : rate);
  }
  return fastest;
}

/// The longest way that a drive makes, to and fro counted [rad, largest lengths].
double longest_way(const Mechanism& mechanism, const MotionRange& motion_range) {
  constexpr int kParts = 256;
  DriveClock clock(mechanism);
  double longest = 0;
  for (std::size_t d = 0; d < mechanism.drives.size(); ++d) {
    double way = 0, before = clock.at(d, motion_range.begin).value;
    for (int k = 1; k <= kParts; ++k) {
      const double value = clock.at(d, motion_range.begin + motion_range.duration() * k / kParts).value;
      way += std::abs(value - before);
      before = value;
    }
    longest = std::max(longest, mechanism.drives[d].slide ? way / mechanism.largest_length() : way);
  }
  return longest;
}

bool closes(const Mechanism& mechanism, const Configuration& first, const Configuration& last) {
  constexpr double kSame = 1e-7;  // a change point at the start leaves the root of the rounding
  if (first.status == Status::open || last.status == Status::open) return false;
  for (std::size_t p = 0; p < first.points.size(); ++p) {
    const Eigen::Vector2d way = last.points[p].position - first.points[p].position;
    if (!(way.norm() <= kSame * mechanism.largest_length())) return false;
  }
  return true;
}

}  // namespace

double MotionRange::time(double u) const {
  const double way = end - begin;
  if (from_limit && at_limit)
    return u == 1 ? end : begin + way * std::pow(std::sin(u * std::numbers::pi / 2), 2);
  if (at_limit) return end - way * (1 - u) * (1 - u);
  return begin + way * (from_limit ? u * u : u);
}

double MotionRange::rate(double u) const {
  const double way = end - begin;
  if (from_limit && at_limit) return way * std::numbers::pi / 2 * std::sin(u * std::numbers::pi);
  if (at_limit) return 2 * way * (1 - u);
  return from_limit ? 2 * way * u : way;
}

MotionRange plan_motion_range(const Mechanism& mechanism, const Structure& structure) {
  MotionRange motion_range;
  const MotionSettings& settings = mechanism.motion;
  if (settings.until && settings.at_limit.value_or(AtLimit::open) != AtLimit::reverse) {
    check_travel(mechanism, *settings.until);
    motion_range.kind = MotionRange::Kind::until;
    motion_range.end = *settings.until;
    motion_range.range.forward = Follower(mechanism, structure).advance_to_limit(*settings.until);
  } else {
    motion_range.range = find_range(mechanism, structure);
    if (!motion_range.range.forward || !motion_range.range.backward)
      motion_range.end = cycle(mechanism, structure);
  }
  const auto margin = [&](const MotionEvent& end) {
    const bool far = end.kind == MotionEvent::Kind::infinity;
    return (far ? kBeforeInfinity : kBeforeLimit) / fastest_rate(mechanism);
  };
  if (motion_range.range.backward) {
    motion_range.from_limit = true;
    motion_range.begin = motion_range.range.backward->time + margin(*motion_range.range.backward);
  }
  if (motion_range.range.forward) {
    motion_range.at_limit = true;
    motion_range.end = motion_range.range.forward->time - margin(*motion_range.range.forward);
  }
  if (motion_range.from_limit || motion_range.at_limit) {
    motion_range.kind = motion_range.from_limit && motion_range.at_limit ? MotionRange::Kind::limits
                                                                         : MotionRange::Kind::to_limit;
  }
  Follower follower(mechanism, structure);
  const Configuration first = follower.advance(motion_range.begin);
  const std::size_t before = follower.events().size();
  const Configuration& last = follower.advance(motion_range.end);
  motion_range.closed = !motion_range.from_limit && !motion_range.at_limit && closes(mechanism, first, last);
  for (std::size_t i = before; i < follower.events().size(); ++i) {
    if (follower.events()[i].kind == MotionEvent::Kind::change)
      motion_range.changes.push_back(follower.events()[i]);
  }
  const double wanted = std::ceil(longest_way(mechanism, motion_range) / kSampleStep);
  motion_range.samples = static_cast<std::size_t>(
      std::clamp(wanted, static_cast<double>(kFewestSamples), static_cast<double>(kMostSamples)));
  return motion_range;
}

RangeWalk::RangeWalk(const Mechanism& mechanism, const Structure& structure, MotionRange motion_range)
    : mechanism_(mechanism),
      structure_(structure),
      motion_range_(std::move(motion_range)),
      follower_(mechanism, structure),
      clock_(mechanism),
      drives_(mechanism.drives.size()) {
  go(0);
}

const Configuration& RangeWalk::go(double u) {
  place_ = u;
  time_ = motion_range_.time(u);
  here_ = &follower_.advance(time_);
  constexpr double kBeside = 1e-6;  // of the motion range: where a collinear triangle has its rates again
  if (here_->status == Status::dead_centre) {
    time_ = motion_range_.time(u < 0.5 ? u + kBeside : u - kBeside);
    here_ = &follower_.advance(time_);
  }
  clock_.at(time_, drives_);
  return *here_;
}

}  // namespace oblique::mechanism
