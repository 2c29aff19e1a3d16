// SPDX-License-Identifier: MIT
// The part of Follower that deals with the points where the modes of a group meet: limits, change points,
// returns.
#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/mechanism/follower.h>

namespace oblique {
namespace {

/// How far a pose may lie from where it would be by its velocity, over the largest length, and still continue
/// it.
constexpr double kNear = 0.02;

}  // namespace

/// Whether group `g` closes at time `t` near to where it would be by its velocity; leaves the pose found in
/// next_.
bool Follower::closes(std::size_t g, double t) {
  predict(t - time_);
  clock_.at(t, next_drives_);
  for (std::size_t before = 0; before < g; ++before) {
    if (kinematics_.solver(before).place(next_drives_, courses_[before].side, next_) == Status::open)
      return false;
  }
  GroupSolver& solver = kinematics_.solver(g);
  if (!solver.is_tracked()) {
    return solver.place(next_drives_, courses_[g].side, next_) != Status::open;
  }
  const std::vector<PointState> guess = next_.points;
  if (solver.place(next_drives_, 0, next_) == Status::open) return false;
  double far = 0;
  for (const std::size_t point : kinematics_.structure().groups[g].points)
    far = std::max(far, (next_.points[point].position - guess[point].position).norm());
  return far < kNear * mechanism_.largest_length();
}

/// The time of a limit between one where the group closes and one where it does not.
double Follower::limit_between(std::size_t g, double inside, double outside) {
  while (std::abs(outside - inside) > smallest_) {
    const double middle = inside + (outside - inside) / 2;
    if (middle == inside || middle == outside) break;
    (closes(g, middle) ? inside : outside) = middle;
  }
  return inside;
}

/// Looks for a mode of group `g` at time `to` that goes on from here by its velocity, and takes it.
bool Follower::passes(std::size_t g, double from, double to) {
  predict(to - from);
  const Configuration guess = next_;
  clock_.at(to, next_drives_);
  for (std::size_t before = 0; before < g; ++before) {
    if (kinematics_.solver(before).place(next_drives_, courses_[before].side, next_) == Status::open)
      return false;
  }
  GroupSolver& solver = kinematics_.solver(g);
  const Group& group = kinematics_.structure().groups[g];
  const auto distance = [&](const Configuration& there) {
    double far = 0;
    for (const std::size_t point : group.points)
      far = std::max(far, (there.points[point].position - guess.points[point].position).norm());
    return far;
  };
  double nearest = std::numeric_limits<double>::infinity();
  Configuration found;
  int side = 0;
  const auto consider = [&](Configuration there, Status status, int its_side) {
    if (status == Status::open || distance(there) >= nearest) return;
    nearest = distance(there);
    found = std::move(there);
    side = its_side;
  };
  if (solver.is_tracked()) {
    Configuration there = next_;
    const Status status = solver.place(next_drives_, 0, there);
    consider(std::move(there), status, 0);
  } else {
    for (const int candidate : {+1, -1}) {
      Configuration there = next_;
      const Status status = solver.place(next_drives_, candidate, there);
      consider(std::move(there), status, candidate);
    }
  }
  // the two modes are as far apart as the regularity says; the right one is nearer by orders
  const double size = mechanism_.largest_length();
  if (!(nearest < std::abs(courses_[g].regularity) * size / 2)) return false;
  courses_[g].side = side;
  return true;
}

/// Passes the point ahead where the modes of group `g` meet, or ends before it.
Follower::Crossing Follower::cross(std::size_t g, double t) {
  const Course& course = courses_[g];
  const double direction = t > time_ ? 1 : -1;
  const double zero = std::abs(course.regularity / course.slope);  // of a regularity that falls in a line
  const double from = time_, to = time_ + direction * 2 * zero;
  bool opens = false;
  for (const double part : {0.25, 0.5, 0.75, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75}) {
    if (kinematics_.solver(g).is_tracked()) break;
    opens = opens || !closes(g, time_ + direction * part * zero);
  }
  const int side = course.side;
  if (!opens && passes(g, from, to)) {
    if ((t - to) * direction <= 0) {  // the time asked for lies amidst
      const bool there = passes(g, from, t) && place_all(t);
      courses_[g].side = side;
      shown_ = next_;
      return there ? Crossing::amidst : Crossing::limit;
    }
    events_.push_back({MotionEvent::Kind::change, time_ + direction * zero, g});
    if (!place_all(to)) return Crossing::limit;
    accept(to);
    probe();
    return Crossing::passed;
  }
  if (closes(g, t) && place_all(t) && std::abs(t - time_) <= 2 * zero) {  // just before a limit
    shown_ = next_;
    return Crossing::amidst;
  }
  // a limit: between here and twice as far as a root would have it
  double outside = to;
  for (int i = 0; i < 60 && closes(g, outside); ++i) outside = time_ + direction * zero * std::pow(1.5, i);
  const double at = limit_between(g, time_, outside);
  events_.push_back({MotionEvent::Kind::limit, at, g});
  return Crossing::limit;
}

/// All groups at time `t`, in next_; false where one is open.
bool Follower::place_all(double t) {
  if (started_) predict(t - time_);
  clock_.at(t, next_drives_);
  next_.status = Status::ok;
  next_.group.reset();
  for (std::size_t g = 0; g < courses_.size(); ++g) {
    GroupSolver& solver = kinematics_.solver(g);
    const Status status = solver.place(next_drives_, courses_[g].side, next_);
    regularities_[g] = solver.regularity();
    culprit_ = g;
    if (status == Status::open) return false;
    if (status == Status::dead_centre) {
      if (!next_.group) next_.group = g;
      next_.status = status;
    }
  }
  return true;
}

bool Follower::try_to_return(double t) {
  // a pose of which nothing is left as a guess but the last one before the limit
  clock_.at(t, next_drives_);
  predict(0);
  next_.status = Status::ok;
  next_.group.reset();
  const Structure& structure = kinematics_.structure();
  for (std::size_t g = 0; g < courses_.size(); ++g) {
    GroupSolver& solver = kinematics_.solver(g);
    Status status = Status::open;
    if (!solver.is_tracked()) {
      status = solver.place(next_drives_, courses_[g].side, next_);
    } else {
      const GroupPoses poses = solver.poses(next_drives_, next_);
      double nearest = std::numeric_limits<double>::infinity();
      Configuration found;
      for (const GroupPose& pose : poses.poses) {
        Configuration there = next_;
        const Status its = solver.place(next_drives_, pose, there);
        if (its == Status::open || (solver.regularity() > 0) != (courses_[g].regularity > 0)) continue;
        double far = 0;
        for (const std::size_t point : structure.groups[g].points)
          far += (there.points[point].position - here_.points[point].position).norm();
        if (far >= nearest) continue;
        nearest = far;
        status = its;
        found = std::move(there);
      }
      if (status != Status::open) next_ = std::move(found);
    }
    regularities_[g] = solver.regularity();
    if (status == Status::open) {
      culprit_ = g;
      return false;
    }
    if (status == Status::dead_centre) {
      next_.group = g;
      next_.status = status;
    }
  }
  return true;
}

}  // namespace oblique
