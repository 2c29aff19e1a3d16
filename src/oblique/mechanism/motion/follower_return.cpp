// SPDX-License-Identifier: MIT
// The part of Follower that knows, beyond a limit, where the branch that was left begins anew.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <oblique/mechanism/motion/follower.h>

namespace oblique::mechanism {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// A branch that goes on for more turns of its drive than this is not looked at to its other end.
constexpr double kMostTurns = 16;
/// How far within its ends a branch is taken up again [rad], where both are known to 1e-11 or so.
constexpr double kInside = 1e-9;

}  // namespace

/// Finds out where the branch that has just been left at a limit goes on: of a single drive that turns, its
/// other end, by following it all the way back.
void Follower::leave_branch() {
  time_ = events_.back().time;
  Gap gap{standing_, {}, 0, 0, std::numeric_limits<double>::infinity()};
  if (mechanism_.drives.size() == 1) {
    drives_at(time_, next_drives_);
    gap.end = next_drives_.front().value;
    const double from = standing_.drives.front().value;
    gap.outward = gap.end > from ? 1 : -1;
    if (!mechanism_.drives.front().slide && gap.end != from) {
      Follower back(*this, standing_, {-gap.outward});
      if (const auto other = back.advance_to_limit(kMostTurns * kTurn)) {
        const double length = std::abs(gap.end - from) + other->time;
        const double turns = std::ceil(length / kTurn);
        gap.width = turns * kTurn - length;
        gap.ahead = back.standing_;
        gap.ahead.drives.front().value += gap.outward * turns * kTurn;
      }
    }
  }
  gap_ = std::move(gap);
}

/// Goes on, open, towards `t` until the branch can be taken up again, and stands on it then; false where it
/// stays open.
bool Follower::come_back(double t) {
  return gap_ && (mechanism_.drives.size() == 1 ? come_back_alone(t) : come_back_together(t));
}

bool Follower::come_back_alone(double t) {
  const std::size_t group = culprit_;
  const double scale = mechanism_.drives.front().slide ? mechanism_.largest_length() : 1;
  const double inside = kInside * scale;
  const auto beyond = [&](double time) {
    drives_at(time, next_drives_);
    return gap_->outward * (next_drives_.front().value - gap_->end);
  };
  const auto is_back = [&](double time, double margin) {
    const double way = beyond(time);
    return way <= -margin || way >= gap_->width + margin;
  };
  /// The moment between two of which the second is back.
  const auto first_back = [&](double outside, double within, double margin) {
    while (true) {
      const double middle = outside + (within - outside) / 2;
      if (middle == outside || middle == within) return within;
      (is_back(middle, margin) ? within : outside) = middle;
    }
  };
  double from = time_, here = beyond(from);
  while (from != t) {
    double dt = std::min(duration_of_degree_, std::abs(t - from));
    double to = 0, there = 0;
    constexpr double kLongest = 3 * std::numbers::pi / 180;  // a law may be faster than at its start
    while (true) {
      to = dt == std::abs(t - from) ? t : from + std::copysign(dt, t - from);
      there = beyond(to);
      if (std::abs(there - here) <= kLongest * scale || dt < smallest_) break;
      dt /= 2;
    }
    if (is_back(to, inside)) {
      const double within = first_back(from, to, inside);
      if (enter(beyond(within) < 0 ? gap_->behind : gap_->ahead, within)) {
        events_.push_back({MotionEvent::Kind::return_, first_back(from, within, 0), group});
        return true;
      }
    }
    from = to;
    here = there;
  }
  return false;
}

/// Of several drives: looks from degree to degree whether the straight way of all of them from where the
/// branch was left, by the nearest turns, is free.
bool Follower::come_back_together(double t) {
  const std::size_t group = culprit_;
  // of each drive that turns, the last turn before the one that it stands in now, or the next one
  const auto try_at = [&](double time) {
    std::size_t ways = 1;
    for (const Drive& drive : mechanism_.drives) ways *= drive.slide ? 1U : 2U;
    for (std::size_t way = 0; way < ways; ++way) {
      drives_at(time, next_drives_);
      Standing from = gap_->behind;
      for (std::size_t d = 0, bits = way; d < from.drives.size(); ++d) {
        if (mechanism_.drives[d].slide) continue;
        double& value = from.drives[d].value;
        const double turns = (next_drives_[d].value - value) / kTurn;
        value += kTurn * (bits % 2 == 0 ? std::floor(turns) : std::ceil(turns));
        bits /= 2;
      }
      if (enter(from, time)) return true;
    }
    return false;
  };
  const Standing left = standing();
  const double since = time_;
  const auto go_back = [&] {
    here_ = left.here;
    courses_ = left.courses;
    drives_ = left.drives;
    angles_ = left.angles;
    time_ = since;
  };
  for (double from = time_; from != t;) {
    const double dt = std::min(duration_of_degree_, std::abs(t - from));
    const double to = dt == std::abs(t - from) ? t : from + std::copysign(dt, t - from);
    if (try_at(to)) {
      double outside = from, within = to;
      while (std::abs(within - outside) > smallest_) {
        const double middle = outside + (within - outside) / 2;
        if (middle == outside || middle == within) break;
        go_back();
        (try_at(middle) ? within : outside) = middle;
      }
      go_back();
      const double beside = 100 * smallest_;  // where rates have values again
      if (std::abs(to - within) > beside && try_at(within + std::copysign(beside, t - from))) {
        events_.push_back({MotionEvent::Kind::return_, within, group});
        return true;
      }
      go_back();
    }
    from = to;
  }
  return false;
}

/// Stands at time `t` as the straight way of the drives leads there from a standing on the branch; false, and
/// nothing is changed, where a limit lies on it.
bool Follower::enter(const Standing& from, double t) {
  drives_at(t, next_drives_);
  std::vector<double> way;
  double longest = 0;
  for (std::size_t d = 0; d < next_drives_.size(); ++d) {
    way.push_back(next_drives_[d].value - from.drives[d].value);
    longest = std::max(longest, std::abs(way.back()));
  }
  if (!(longest > 0)) return false;
  Follower along(*this, from, std::move(way));
  if (along.advance_to_limit(1) || along.here_.status != Status::ok || along.time_ != 1) return false;
  const std::vector<Course> before = courses_;
  courses_ = along.courses_;
  std::swap(here_, along.here_);
  std::swap(angles_, along.angles_);
  const double time = time_;
  time_ = t;
  if (!place_all(t)) {
    std::swap(here_, along.here_);
    std::swap(angles_, along.angles_);
    courses_ = before;
    time_ = time;
    return false;
  }
  accept(t);
  step_ = 10 * smallest_;
  probe(smallest_);
  return true;
}

}  // namespace oblique::mechanism
