// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/crossings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

/// Below this part of its largest determinant a group is at the point where its modes meet: the height of a
/// triangle is then a few times what counts as collinear, so that rates still have a value.
constexpr double kSingular = 1e-6;
/// Within these ways of the fastest drive [rad] what is left out beyond the second order is rounding: of a
/// crossing it is of third order in the way, of a fold of third order in its root. Where no step leads
/// nearer, one of two folds a little way apart, farther away is near.
constexpr double kNearCrossing = 1e-5, kNearFold = 1e-9, kNearLastFold = 1e-6;
/// From this many sizes away on a group may go to infinity. One that is followed by Newton's method passes it
/// from there: its rounding grows with the third power of the distance (a body that is told of by a point so
/// far away turns by that point's rounding, and the other end of the lever moves by as much more). So no pose
/// of it is told beyond kFarthest.
constexpr double kFar = 300, kFarthest = 1e6;

/// Group `g` in `next`, at the states of `next_drives`, in that of its modes to which its velocity leads
/// within `dt`; false where none is near.
bool place_next_to_velocity(BranchWalk& walk, std::size_t g, double dt) {
  GroupSolver& solver = walk.kinematics.solver(g);
  const Group& group = walk.kinematics.structure().groups[g];
  for (const std::size_t point : group.points) walk.next.points[point] = walk.here.points[point];
  for (const std::size_t body : group.bodies) walk.next.bodies[body] = walk.here.bodies[body];
  const Eigen::VectorXd step = dt * solver.velocity(walk.here);
  if (!step.allFinite()) return false;
  solver.displace(step, walk.next);
  const Configuration guess = walk.next;
  // the modes lie as far apart as the determinant says; the right one is nearer to the guess by orders
  double nearest =
      std::max(std::abs(walk.courses[g].determinant), 1e-9) * walk.mechanism.largest_length() / 2;
  bool found = false;
  Configuration best;
  const std::array<int, 2> sides{1, -1};
  const std::size_t count = solver.is_tracked() || solver.is_single() ? 1 : 2;
  for (std::size_t i = 0; i < count; ++i) {
    Configuration there = guess;
    const int side = count == 1 ? 0 : sides[i];
    if (solver.place(walk.next_drives, side, there) == Status::open) continue;
    double far = 0;
    for (const std::size_t point : group.points) {
      const Vector2d way = there.points[point].position - walk.here.points[point].position;
      far = std::max(far, (way - dt * walk.here.points[point].velocity).norm());
    }
    if (!(far < nearest)) continue;
    found = true;
    nearest = far;
    best = std::move(there);
    walk.determinants[g] = solver.normalised_determinant();
    walk.courses[g].side = side;
  }
  if (found) walk.next = std::move(best);
  return found;
}

/// Passes a change point of group `g` a time `zero` from here, and of all groups that pass one with it.
Crossing cross_modes(BranchWalk& walk, std::size_t g, double t, double zero) {
  const std::vector<BranchWalk::Course> before = walk.courses;
  const double direction = zero > 0 ? 1 : -1;
  const bool at_singularity = (t - walk.time - 2 * zero) * direction <= 0;
  const double to = at_singularity ? t : walk.time + 2 * zero;
  walk.predict(to - walk.time);
  walk.drives_at(to, walk.next_drives);
  walk.next.status = Status::ok;
  walk.next.group.reset();
  std::vector<std::size_t> passing;
  for (std::size_t i = 0; i < walk.courses.size(); ++i) {
    constexpr double kBeside = 1e3 * kSingular;
    GroupSolver& solver = walk.kinematics.solver(i);
    const bool passes = i == g || std::abs(before[i].determinant) < kBeside * before[i].peak;
    Status status = Status::ok;
    if (!passes) {
      status = solver.place(walk.next_drives, walk.courses[i].side, walk.next);
      walk.determinants[i] = solver.normalised_determinant();
    } else if (place_next_to_velocity(walk, i, to - walk.time)) {
      const bool is_dead_centre =
          std::isnan(walk.next.points[walk.kinematics.structure().groups[i].points.front()].velocity.x());
      status = is_dead_centre ? Status::dead_centre : Status::ok;
      if ((walk.determinants[i] > 0) != (before[i].determinant > 0)) passing.push_back(i);
    } else if (at_singularity) {  // a group without a place of its own there: the one that it passes
      solver.stand(walk.next_drives, walk.next);
      status = Status::dead_centre;
    } else {
      status = Status::open;
    }
    if (status == Status::open) {
      walk.courses = before;
      return Crossing::regular;
    }
    if (status == Status::dead_centre) {
      if (!walk.next.group) walk.next.group = i;
      walk.next.status = status;
    }
  }
  if (at_singularity) {
    walk.courses = before;
    walk.shown = walk.next;
    walk.show(t);
    return Crossing::at_singularity;
  }
  if (std::find(passing.begin(), passing.end(), g) == passing.end()) {
    walk.courses = before;
    return Crossing::regular;
  }
  for (const std::size_t i : passing) walk.events.push_back({MotionEvent::Kind::change, walk.time + zero, i});
  walk.accept(to);
  walk.step = std::abs(zero);
  walk.probe(1e-2 * zero);
  return Crossing::passed;
}

/// Ends at a limit a time `tau` from here.
Crossing end_at(BranchWalk& walk, std::size_t g, double t, double tau, const Singularity& singularity) {
  // From another pose before it the limit is found to lie elsewhere by a part of the way.
  constexpr double kOfWay = 1e-3;
  const double way = t - walk.time;
  if (std::abs(way) <= (1 + kOfWay) * std::abs(tau)) {
    const double dt = std::abs(way) < std::abs(tau) ? way : tau;
    walk.predict(dt);
    const Structure& structure = walk.kinematics.structure();
    for (const std::size_t point : structure.groups[g].points)
      walk.next.points[point] = walk.here.points[point];
    for (const std::size_t body : structure.groups[g].bodies) walk.next.bodies[body] = walk.here.bodies[body];
    walk.kinematics.solver(g).displace(singularity.branch(dt) * singularity.along + dt * singularity.drift,
                                       walk.next);
    walk.drives_at(walk.time + dt, walk.next_drives);
    walk.next.status = Status::ok;
    walk.next.group.reset();
    for (std::size_t i = 0; i < walk.courses.size() && walk.next.status != Status::open; ++i) {
      const Status status =
          walk.kinematics.solver(i).place(walk.next_drives, walk.courses[i].side, walk.next);
      if (status == Status::ok) continue;
      walk.next.status = status;
      walk.next.group = i;
    }
    if (walk.next.status == Status::open) {
      walk.show_open(t, g);
    } else {
      walk.shown = walk.next;
      walk.show(t);
    }
    return Crossing::at_singularity;
  }
  walk.events.push_back({MotionEvent::Kind::limit, walk.time + tau, g});
  walk.step = walk.duration_of_degree;
  return Crossing::limit;
}

/// How long a point that goes away as x = c + k/(t∞ − t) is from infinity: 2 ẋ²/(ẋ·ẍ).
double time_to_infinity(const PointState& point) {
  return 2 * point.velocity.squaredNorm() / point.velocity.dot(point.acceleration);
}

/// Passes infinity: a way h from here, and Δ before it, a point stands at x + ẋ Δ h/(Δ − h), on either side.
Crossing cross_infinity(BranchWalk& walk, std::size_t g, double t) {
  GroupSolver& solver = walk.kinematics.solver(g);
  const Group& group = walk.kinematics.structure().groups[g];
  const Vector2d origin = walk.here.points.front().position;  // the points of the frame come first
  const auto farthest =
      *std::max_element(group.points.begin(), group.points.end(), [&](std::size_t a, std::size_t b) {
        return (walk.here.points[a].position - origin).norm() <
               (walk.here.points[b].position - origin).norm();
      });
  const PointState& point = walk.here.points[farthest];
  const double left = time_to_infinity(point);
  const double radian = walk.duration_of_degree * 180 / std::numbers::pi;
  constexpr double kBrief = 0.05, kAtIt = 1e-9;  // rad
  if (!((t - walk.time) * left > 0 && std::abs(left) < kBrief * radian)) return Crossing::regular;
  const double away = solver.distance(walk.here);
  const double at_it = solver.is_tracked() ? std::abs(left) * away / kFarthest : kAtIt * radian;
  const bool at_singularity = (t - walk.time - 2 * left) * left <= 0;
  if (at_singularity && std::abs(t - walk.time - left) < at_it) {
    walk.show_open(t, g);
    return Crossing::at_singularity;
  }
  const double to = at_singularity ? t : walk.time + 2 * left;
  const double h = to - walk.time;
  walk.predict(h);
  for (const std::size_t p : group.points) walk.next.points[p] = walk.here.points[p];
  for (const std::size_t body : group.bodies) walk.next.bodies[body] = walk.here.bodies[body];
  Eigen::VectorXd step = solver.velocity(walk.here);
  const auto leap = [&](Eigen::Index k) {  // a point as a whole: how its axes lie says nothing
    const bool goes_far =
        std::abs(left) * step.segment<2>(k).norm() > 0.1 * away * walk.mechanism.largest_length();
    step.segment<2>(k) *= goes_far ? left * h / (left - h) : h;
  };
  Eigen::Index k = 0;
  for (std::size_t i = 0; i < group.equations.platforms.size(); ++i, k += 3) {
    leap(k);
    step(k + 2) *= h;
  }
  for (; k < step.size(); k += 2) leap(k);
  solver.displace(step, walk.next);
  walk.drives_at(to, walk.next_drives);
  walk.next.status = Status::ok;
  walk.next.group.reset();
  for (std::size_t i = 0; i < walk.courses.size(); ++i) {
    if (walk.kinematics.solver(i).place(walk.next_drives, walk.courses[i].side, walk.next) != Status::ok)
      return Crossing::regular;
    walk.determinants[i] = walk.kinematics.solver(i).normalised_determinant();
  }
  const double beyond = solver.distance(walk.next), before = std::abs(walk.courses[g].determinant);
  const double there = std::abs(walk.determinants[g]);
  const bool is_beyond = (h - left) * left > 0;
  const bool other_side = (walk.next.points[farthest].position - origin).dot(point.position - origin) < 0;
  if (other_side != is_beyond || !(beyond > away / 2)) return Crossing::regular;
  if (at_singularity) {
    walk.shown = walk.next;
    walk.show(t);
    return Crossing::at_singularity;
  }
  if (!(beyond < 2 * away && there > before / 4 && there < 4 * before)) return Crossing::regular;
  // what is left out has other signs on the two sides
  const double seen_back = to + time_to_infinity(walk.next.points[farthest]);
  const double time = (walk.time + left + seen_back) / 2;
  walk.events.push_back({MotionEvent::Kind::infinity, time, g});
  if (walk.stops_at_infinity) return Crossing::passed;
  walk.accept(to);
  walk.step = std::abs(left);
  return Crossing::passed;
}

/// What lies ahead of group `g`, whose modes meet nearby.
Crossing cross_at(BranchWalk& walk, std::size_t g, double t, bool is_last) {
  GroupSolver& solver = walk.kinematics.solver(g);
  if (solver.distance(walk.here) > kFar) {
    const Crossing crossing = cross_infinity(walk, g, t);
    if (crossing != Crossing::regular) return crossing;
  }
  const double way = t - walk.time;
  const double radian = walk.duration_of_degree * 180 / std::numbers::pi;
  const Singularity singularity = solver.singularity(walk.drives, walk.here, radian);
  const auto meeting = singularity.crossing();
  if (meeting && meeting->time * way > 0 && std::abs(meeting->time) < kNearCrossing * radian) {
    const Crossing crossing = cross_modes(walk, g, t, meeting->time);
    if (crossing != Crossing::regular) return crossing;
  }
  const auto fold = singularity.fold(way);
  const double near = is_last ? kNearLastFold : kNearFold;
  if (fold && std::abs(*fold) < near * radian) return end_at(walk, g, t, *fold, singularity);
  if (!is_last) return Crossing::regular;
  walk.events.push_back({MotionEvent::Kind::lost, walk.time, g});
  walk.step = walk.duration_of_degree;
  return Crossing::limit;
}

}  // namespace

Crossing step_towards(BranchWalk& walk, double t) {
  const double way = t - walk.time;
  double dt = std::min({walk.step, walk.duration_of_degree, std::abs(way)});
  // nearer to where modes meet than this no pose tells them apart, so none is taken there
  for (std::size_t g = 0; g < walk.courses.size(); ++g) {
    const BranchWalk::Course& course = walk.courses[g];
    const bool falls = course.derivative * course.determinant * way < 0;
    const double dead_centre = walk.kinematics.solver(g).is_tracked() ? kMeeting : 0;
    Crossing crossing = Crossing::regular;
    if (falls && std::abs(course.determinant) < std::max(kSingular * course.peak, 2 * dead_centre)) {
      crossing = cross_at(walk, g, t, false);
    } else if (const GroupSolver& solver = walk.kinematics.solver(g);
               solver.is_tracked() && solver.distance(walk.here) > kFar) {
      crossing = cross_infinity(walk, g, t);  // where the determinant may fall or grow without end
    }
    if (crossing != Crossing::regular) return crossing;
  }
  while (true) {
    // the last step ends at t itself
    const double target = dt == std::abs(way) ? t : walk.time + std::copysign(dt, way);
    if (walk.tracks) walk.predict(target - walk.time);
    const BranchWalk::Verdict verdict = walk.attempt(target);
    if (verdict == BranchWalk::Verdict::good) {
      walk.accept(target);
      walk.step = std::min(std::max(walk.step, 2 * dt),
                           walk.duration_of_degree);  // a near row is no reason to go slower
      return Crossing::passed;
    }
    if (walk.step == walk.duration_of_degree) walk.last_clear = walk.place();
    walk.step = dt /= 2;
    if (dt < walk.smallest) return cross_at(walk, walk.culprit, t, true);
  }
}

std::optional<MotionEvent> walk_to_limit(BranchWalk& walk, double t) {
  const auto ends = [&](const MotionEvent& event) {
    return event.ends() && (walk.stops_at_infinity || event.kind != MotionEvent::Kind::infinity);
  };
  while (walk.time != t) {
    const std::size_t before = walk.events.size();
    const Crossing crossing = step_towards(walk, t);
    if (crossing == Crossing::at_singularity || crossing == Crossing::limit) break;
    if (walk.events.size() > before && ends(walk.events.back())) break;
  }
  for (const MotionEvent& event : walk.events) {
    if (ends(event) && std::abs(event.time) <= std::abs(t)) return event;
  }
  return std::nullopt;
}

}  // namespace oblique::mechanism
