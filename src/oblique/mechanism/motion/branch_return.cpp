// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/branch_return.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/motion/crossings.h>

namespace oblique::mechanism {
namespace {

/// A branch that goes on for more turns of its drive than this is not looked at to its other end.
constexpr double kMostTurnsBack = 16;
/// How far within its ends a branch is taken up again [rad], where both are known to 1e-11 or so; and farther
/// by these steps, up to this far, where its modes are not told apart yet.
constexpr double kInside = 1e-9, kFartherInside = 10, kFarthestInside = 1e-2;

/// The first of these: farther in where the frame lies more than 100 sizes from the origin, and the rounding
/// of coordinates hides near the end which mode is which.
double first_inside(const Mechanism& mechanism) {
  constexpr double kNear = 100;  // sizes
  double farthest = 0;
  for (const Point& point : mechanism.points) {
    if (point.fixed) farthest = std::max(farthest, point.position.cwiseAbs().maxCoeff());
  }
  return kInside * std::max(1.0, farthest / (kNear * mechanism.largest_length()));
}

/// Stands at time `t` as the straight way of the drives leads there from a place on the branch; false, and
/// nothing is changed, where a limit lies on it.
bool enter(BranchWalk& walk, const BranchWalk::Place& from, double t) {
  walk.drives_at(t, walk.next_drives);
  std::vector<double> way;
  double longest = 0;
  for (std::size_t d = 0; d < walk.next_drives.size(); ++d) {
    way.push_back(walk.next_drives[d].value - from.drives[d].value);
    longest = std::max(longest, std::abs(way.back()));
  }
  if (!(longest > 0)) return false;
  BranchWalk along(walk, from, std::move(way));
  if (walk_to_limit(along, 1) || along.here.status != Status::ok || along.time != 1) return false;
  const std::vector<BranchWalk::Course> before = walk.courses;
  walk.courses = along.courses;
  std::swap(walk.here, along.here);
  std::swap(walk.angles, along.angles);
  const double time = walk.time;
  walk.time = t;
  if (!walk.place_all(t)) {
    std::swap(walk.here, along.here);
    std::swap(walk.angles, along.angles);
    walk.courses = before;
    walk.time = time;
    return false;
  }
  walk.accept(t);
  walk.step = 10 * walk.smallest;
  walk.probe(walk.smallest);
  return true;
}

bool come_back_alone(BranchWalk& walk, Gap& gap, double t) {
  const std::size_t group = walk.culprit;
  const double scale = walk.mechanism.drives.front().slide ? walk.mechanism.largest_length() : 1;
  const auto beyond = [&](double time) {
    walk.drives_at(time, walk.next_drives);
    return gap.outward * (walk.next_drives.front().value - gap.end);
  };
  const auto is_back = [&](double time, double margin) {
    const double way = beyond(time);
    return way <= -margin || way >= gap.width + margin;
  };
  /// The moment between two of which the second is back.
  const auto first_back = [&](double outside, double within, double margin) {
    double middle = std::midpoint(outside, within);
    while (middle != outside && middle != within) {
      (is_back(middle, margin) ? within : outside) = middle;
      middle = std::midpoint(outside, within);
    }
    return within;
  };
  double from = walk.time, here = beyond(from);
  while (from != t) {
    double dt = std::min(walk.duration_of_degree, std::abs(t - from));
    double to = 0, there = 0;
    constexpr double kLongest = 3 * std::numbers::pi / 180;  // a law may be faster than at its start
    while (true) {
      to = dt == std::abs(t - from) ? t : from + std::copysign(dt, t - from);
      there = beyond(to);
      if (std::abs(there - here) <= kLongest * scale || dt < walk.smallest) break;
      dt /= 2;
    }
    if (!is_back(to, 0)) {
      gap.reached.reset();
    } else if (!gap.reached) {
      gap.reached = first_back(from, to, 0);
    }
    for (double inside = first_inside(walk.mechanism) * scale;
         inside <= kFarthestInside * scale && is_back(to, inside); inside *= kFartherInside) {
      const double within = first_back(*gap.reached, to, inside);
      if (!enter(walk, beyond(within) < 0 ? gap.behind : gap.ahead, within)) continue;
      walk.events.push_back({MotionEvent::Kind::return_, *gap.reached, group});
      return true;
    }
    from = to;
    here = there;
  }
  return false;
}

/// Of several drives: looks from degree to degree whether the straight way of all of them from where the
/// branch was left, by the nearest turns, is free.
bool come_back_together(BranchWalk& walk, const Gap& gap, double t) {
  const std::size_t group = walk.culprit;
  // of each drive that turns, the last turn before the one that it stands in now, or the next one
  const auto try_at = [&](double time) {
    std::size_t ways = 1;
    for (const Drive& drive : walk.mechanism.drives) ways *= drive.slide ? 1U : 2U;
    for (std::size_t way = 0; way < ways; ++way) {
      walk.drives_at(time, walk.next_drives);
      BranchWalk::Place from = gap.behind;
      for (std::size_t d = 0, bits = way; d < from.drives.size(); ++d) {
        if (walk.mechanism.drives[d].slide) continue;
        double& value = from.drives[d].value;
        const double turns = (walk.next_drives[d].value - value) / kTurn;
        value += kTurn * (bits % 2 == 0 ? std::floor(turns) : std::ceil(turns));
        bits /= 2;
      }
      if (enter(walk, from, time)) return true;
    }
    return false;
  };
  const BranchWalk::Place left = walk.place();
  const double since = walk.time;
  const auto go_back = [&] {
    walk.here = left.here;
    walk.courses = left.courses;
    walk.drives = left.drives;
    walk.angles = left.angles;
    walk.time = since;
  };
  for (double from = walk.time; from != t;) {
    const double dt = std::min(walk.duration_of_degree, std::abs(t - from));
    const double to = dt == std::abs(t - from) ? t : from + std::copysign(dt, t - from);
    if (try_at(to)) {
      double outside = from, within = to;
      while (std::abs(within - outside) > walk.smallest) {
        const double middle = outside + (within - outside) / 2;
        if (middle == outside || middle == within) break;
        go_back();
        (try_at(middle) ? within : outside) = middle;
      }
      go_back();
      const double beside = 100 * walk.smallest;  // where rates have values again
      if (std::abs(to - within) > beside && try_at(within + std::copysign(beside, t - from))) {
        walk.events.push_back({MotionEvent::Kind::return_, within, group});
        return true;
      }
      go_back();
    }
    from = to;
  }
  return false;
}

}  // namespace

Gap leave_branch(BranchWalk& walk) {
  walk.time = walk.events.back().time;
  Gap gap;
  gap.behind = walk.last_clear;
  gap.width = std::numeric_limits<double>::infinity();
  if (walk.mechanism.drives.size() == 1) {
    walk.drives_at(walk.time, walk.next_drives);
    gap.end = walk.next_drives.front().value;
    const double from = walk.last_clear.drives.front().value;
    gap.outward = gap.end > from ? 1 : -1;
    if (!walk.mechanism.drives.front().slide && gap.end != from) {
      BranchWalk back(walk, walk.last_clear, {-gap.outward});
      if (const auto other = walk_to_limit(back, kMostTurnsBack * kTurn)) {
        const double length = std::abs(gap.end - from) + other->time;
        const double turns = std::ceil(length / kTurn);
        gap.width = turns * kTurn - length;
        gap.ahead = back.last_clear;
        gap.ahead.drives.front().value += gap.outward * turns * kTurn;
      }
    }
  }
  return gap;
}

bool come_back(BranchWalk& walk, Gap& gap, double t) {
  return walk.mechanism.drives.size() == 1 ? come_back_alone(walk, gap, t) : come_back_together(walk, gap, t);
}

}  // namespace oblique::mechanism
