// SPDX-License-Identifier: MIT
// The part of Follower that makes its steps, and deals with the points where the modes of a group meet:
// limits, change points, infinity.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

/// Below this part of its largest regularity a group is at the point where its modes meet: the height of a
/// triangle is then a few times what counts as flat, so that rates still have a value.
constexpr double kSingular = 1e-6;
/// Within these ways of the fastest drive [rad] what is left out beyond the second order is rounding: of a
/// crossing it is of third order in the way, of a fold of third order in its root.
constexpr double kNearCrossing = 1e-5, kNearFold = 1e-9;
/// From this many sizes away on a group may go to infinity.
constexpr double kFar = 300;

}  // namespace

/// One step towards `t`.
Follower::Crossing Follower::step_towards(double t) {
  const double direction = t > time_ ? 1 : -1;
  double dt = std::min({step_, duration_of_degree_, std::abs(t - time_)});
  // nearer to where modes meet than this no pose tells them apart, so none is taken there
  for (std::size_t g = 0; g < courses_.size(); ++g) {
    const Course& course = courses_[g];
    if (std::abs(course.regularity) < kSingular * course.peak &&
        course.slope * course.regularity * direction < 0) {
      const Crossing crossing = cross(g, t, false);
      if (crossing != Crossing::regular) return crossing;
    }
  }
  while (true) {
    // the last step ends at t itself
    const double target = dt == std::abs(t - time_) ? t : time_ + direction * dt;
    if (tracks_) predict(target - time_);
    const Verdict verdict = attempt(target);
    if (verdict == Verdict::good) {
      accept(target);
      step_ = std::min(std::max(step_, 2 * dt), duration_of_degree_);  // a near row is no reason to go slower
      return Crossing::passed;
    }
    if (step_ == duration_of_degree_) standing_ = standing();
    step_ = dt /= 2;
    if (dt < smallest_) return cross(culprit_, t, true);
  }
}

/// All groups at time `t`, in next_; false where one is open.
bool Follower::place_all(double t) {
  if (started_) predict(t - time_);
  drives_at(t, next_drives_);
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

/// What lies ahead of group `g`, whose modes meet nearby.
Follower::Crossing Follower::cross(std::size_t g, double t, bool is_last) {
  GroupSolver& solver = kinematics_.solver(g);
  if (solver.distance(here_) > kFar) {
    const Crossing crossing = cross_infinity(g, t);
    if (crossing != Crossing::regular) return crossing;
  }
  const double direction = t > time_ ? 1 : -1;
  const double radian = duration_of_degree_ * 180 / std::numbers::pi;
  const Singularity singularity = solver.singularity(drives_, here_, radian);
  const auto meeting = singularity.crossing();
  if (meeting && meeting->time * direction > 0 && std::abs(meeting->time) < kNearCrossing * radian) {
    const Crossing crossing = cross_modes(g, t, meeting->time);
    if (crossing != Crossing::regular) return crossing;
  }
  const auto fold = singularity.fold(direction);
  if (fold && std::abs(*fold) < kNearFold * radian) return end_at(g, t, *fold, singularity);
  if (!is_last) return Crossing::regular;
  events_.push_back({MotionEvent::Kind::limit, time_, g});  // no step leads on
  step_ = duration_of_degree_;
  return Crossing::limit;
}

/// Ends at a limit a time `tau` from here.
Follower::Crossing Follower::end_at(std::size_t g, double t, double tau, const Singularity& singularity) {
  const double dt = t - time_;
  if (std::abs(dt) <= std::abs(tau)) {
    predict(dt);
    const Structure& structure = kinematics_.structure();
    for (const std::size_t point : structure.groups[g].points) next_.points[point] = here_.points[point];
    for (const std::size_t body : structure.groups[g].bodies) next_.bodies[body] = here_.bodies[body];
    kinematics_.solver(g).displace(singularity.branch(dt) * singularity.along + dt * singularity.drift,
                                   next_);
    const Configuration guess = next_;
    drives_at(t, next_drives_);
    next_.status = Status::ok;
    next_.group.reset();
    for (std::size_t i = 0; i < courses_.size() && next_.status != Status::open; ++i) {
      const Status status = kinematics_.solver(i).place(next_drives_, courses_[i].side, next_);
      if (status == Status::ok) continue;
      next_.status = status;
      next_.group = i;
    }
    if (next_.status == Status::open) {
      show_open(t, g);
    } else {
      shown_ = next_;
      show(t);
    }
    return Crossing::amidst;
  }
  events_.push_back({MotionEvent::Kind::limit, time_ + tau, g});
  step_ = duration_of_degree_;
  return Crossing::limit;
}

/// Group `g` in next_, at the states of next_drives_, in that of its modes to which its velocity leads within
/// `dt`; false where none is near.
bool Follower::place_next_to_velocity(std::size_t g, double dt) {
  GroupSolver& solver = kinematics_.solver(g);
  const Group& group = kinematics_.structure().groups[g];
  for (const std::size_t point : group.points) next_.points[point] = here_.points[point];
  for (const std::size_t body : group.bodies) next_.bodies[body] = here_.bodies[body];
  const Eigen::VectorXd step = dt * solver.velocity(here_);
  if (!step.allFinite()) return false;
  solver.displace(step, next_);
  const Configuration guess = next_;
  // the modes lie as far apart as the regularity says; the right one is nearer to the guess by orders
  double nearest = std::max(std::abs(courses_[g].regularity), 1e-9) * mechanism_.largest_length() / 2;
  bool found = false;
  Configuration best;
  const std::array<int, 2> sides{1, -1};
  const std::size_t count = solver.is_tracked() || solver.is_single() ? 1 : 2;
  for (std::size_t i = 0; i < count; ++i) {
    Configuration there = guess;
    const int side = count == 1 ? 0 : sides[i];
    if (solver.place(next_drives_, side, there) == Status::open) continue;
    double far = 0;
    for (const std::size_t point : group.points) {
      const Vector2d way = there.points[point].position - here_.points[point].position;
      far = std::max(far, (way - dt * here_.points[point].velocity).norm());
    }
    if (!(far < nearest)) continue;
    found = true;
    nearest = far;
    best = std::move(there);
    regularities_[g] = solver.regularity();
    courses_[g].side = side;
  }
  if (found) next_ = std::move(best);
  return found;
}

/// Passes a change point of group `g` a time `zero` from here, and of all groups that pass one with it.
Follower::Crossing Follower::cross_modes(std::size_t g, double t, double zero) {
  const std::vector<Course> before = courses_;
  const double direction = zero > 0 ? 1 : -1;
  const bool amidst = (t - time_ - 2 * zero) * direction <= 0;
  const double to = amidst ? t : time_ + 2 * zero;
  predict(to - time_);
  drives_at(to, next_drives_);
  next_.status = Status::ok;
  next_.group.reset();
  std::vector<std::size_t> passing;
  for (std::size_t i = 0; i < courses_.size(); ++i) {
    constexpr double kBeside = 1e3 * kSingular;
    GroupSolver& solver = kinematics_.solver(i);
    const bool passes = i == g || std::abs(before[i].regularity) < kBeside * before[i].peak;
    Status status = Status::ok;
    if (!passes) {
      status = solver.place(next_drives_, courses_[i].side, next_);
      regularities_[i] = solver.regularity();
    } else if (place_next_to_velocity(i, to - time_)) {
      const bool flat =
          std::isnan(next_.points[kinematics_.structure().groups[i].points.front()].velocity.x());
      status = flat ? Status::dead_centre : Status::ok;
      if ((regularities_[i] > 0) != (before[i].regularity > 0)) passing.push_back(i);
    } else if (amidst) {  // a group without a place of its own there: the one that it passes
      solver.stand(next_drives_, next_);
      status = Status::dead_centre;
    } else {
      status = Status::open;
    }
    if (status == Status::open) {
      courses_ = before;
      return Crossing::regular;
    }
    if (status == Status::dead_centre) {
      if (!next_.group) next_.group = i;
      next_.status = status;
    }
  }
  if (amidst) {
    courses_ = before;
    shown_ = next_;
    show(t);
    return Crossing::amidst;
  }
  if (std::find(passing.begin(), passing.end(), g) == passing.end()) {
    courses_ = before;
    return Crossing::regular;
  }
  for (const std::size_t i : passing) events_.push_back({MotionEvent::Kind::change, time_ + zero, i});
  accept(to);
  step_ = std::abs(zero);
  probe(1e-2 * zero);
  return Crossing::passed;
}

/// Passes infinity: x = c + k/(t∞ − t), so that the time to it is Δ = 2 ẋ²/(ẋ·ẍ), and a way h from here
/// stands x + ẋ Δ h/(Δ − h), on either side.
Follower::Crossing Follower::cross_infinity(std::size_t g, double t) {
  GroupSolver& solver = kinematics_.solver(g);
  const Group& group = kinematics_.structure().groups[g];
  const auto farthest =
      *std::max_element(group.points.begin(), group.points.end(), [&](std::size_t a, std::size_t b) {
        return here_.points[a].position.norm() < here_.points[b].position.norm();
      });
  const PointState& point = here_.points[farthest];
  const double left = 2 * point.velocity.squaredNorm() / point.velocity.dot(point.acceleration);
  const double radian = duration_of_degree_ * 180 / std::numbers::pi;
  constexpr double kBrief = 0.05, kAtIt = 1e-9;  // rad
  if (!((t - time_) * left > 0 && std::abs(left) < kBrief * radian)) return Crossing::regular;
  const bool amidst = (t - time_ - 2 * left) * left <= 0;
  if (amidst && std::abs(t - time_ - left) < kAtIt * radian) {
    show_open(t, g);
    return Crossing::amidst;
  }
  const double to = amidst ? t : time_ + 2 * left;
  const double h = to - time_, away = solver.distance(here_);
  predict(h);
  for (const std::size_t p : group.points) next_.points[p] = here_.points[p];
  for (const std::size_t body : group.bodies) next_.bodies[body] = here_.bodies[body];
  Eigen::VectorXd step = solver.velocity(here_);
  for (double& part : step) {
    const bool goes_far = std::abs(part * left) > 0.1 * away * mechanism_.largest_length();
    part *= goes_far ? left * h / (left - h) : h;
  }
  solver.displace(step, next_);
  drives_at(to, next_drives_);
  next_.status = Status::ok;
  next_.group.reset();
  for (std::size_t i = 0; i < courses_.size(); ++i) {
    if (kinematics_.solver(i).place(next_drives_, courses_[i].side, next_) != Status::ok)
      return Crossing::regular;
    regularities_[i] = kinematics_.solver(i).regularity();
  }
  const double beyond = solver.distance(next_), before = std::abs(courses_[g].regularity);
  const double there = std::abs(regularities_[g]);
  const bool is_beyond = (h - left) * left > 0;
  const bool other_side = next_.points[farthest].position.dot(point.position) < 0;
  if (other_side != is_beyond || !(beyond > away / 2)) return Crossing::regular;
  if (amidst) {
    shown_ = next_;
    show(t);
    return Crossing::amidst;
  }
  if (!(beyond < 2 * away && there > before / 4 && there < 4 * before)) return Crossing::regular;
  events_.push_back({MotionEvent::Kind::infinity, time_ + left, g});
  if (stop_at_limit_) return Crossing::passed;
  accept(to);
  step_ = std::abs(left);
  probe(1e-2 * left);
  return Crossing::passed;
}

}  // namespace oblique::mechanism
