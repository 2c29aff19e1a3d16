// SPDX-License-Identifier: MIT
// The part of GroupSolver that knows what form a group has and moves its bodies; its positions are found in
// closed_forms.cpp, its linear systems stand in group_newton.cpp.
#include <oblique/mechanism/solver/group_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/mechanism/triad/triangle.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

GroupSolver::GroupSolver(const Mechanism& mechanism, const Group& group)
    : mechanism_(mechanism), group_(group), form_(group.form), equations_(group.equations) {
  const auto n = static_cast<Eigen::Index>(equations_.unknowns());
  cores_.resize(equations_.cores.size());
  free_.resize(equations_.free_points.size());
  jacobian_.setZero(n, n);
  work_.setZero(n, n);
  right_.setZero(n);
  solution_.setZero(n);
  size_ = size_of_group();
  if (form_.dyad) {
    inverse_r1_ = 1 / form_.dyad->r1;
    inverse_r2_ = 1 / form_.dyad->r2;
  }
  plan_bodies();
}

double GroupSolver::size_of_group() const {
  double size = 0;
  for (const Condition& c : equations_.conditions) {
    if (c.kind == Condition::Kind::distance) size = std::max(size, c.value);
    for (const PointRef* point : {&c.a, &c.b}) size = std::max(size, point->local.norm());
    if (c.line.kind != LineRef::Kind::fixed) size = std::max(size, c.line.point.norm());
  }
  return size > 0 ? size : std::max(mechanism_.largest_length(), std::numeric_limits<double>::min());
}

bool GroupSolver::is_tracked() const {
  switch (form_.placing) {
    case Placing::platform:
    case Placing::iteration:
      return true;
    case Placing::rotation:
    case Placing::triangle:
    case Placing::hinged:
    case Placing::crossing:
    case Placing::about_pivot:
      break;
  }
  return false;
}

bool GroupSolver::is_single() const {
  switch (form_.placing) {
    case Placing::rotation:
    case Placing::hinged:
      return true;
    case Placing::crossing:
      return form_.circles == 0;
    case Placing::triangle:
    case Placing::about_pivot:
    case Placing::platform:
    case Placing::iteration:
      break;
  }
  return false;
}

void GroupSolver::plan_bodies() {
  std::vector<bool> done(mechanism_.points.size(), true);
  for (const std::size_t point : group_.points) done[point] = false;
  for (const std::size_t point : equations_.free_points) done[point] = true;
  const auto plan = [&](std::size_t body, std::size_t base) {
    Rigid rigid{body, base, {}};
    done[base] = true;
    const Vector2d& origin = mechanism_.bodies[body].find(base)->local;
    for (const BodyPoint& p : mechanism_.bodies[body].points) {
      if (done[p.point]) continue;
      done[p.point] = true;
      rigid.arms.push_back({p.point, p.local - origin});
    }
    return rigid;
  };
  for (const std::size_t core : equations_.cores) {
    const std::size_t base = mechanism_.bodies[core].points.front().point;
    rigid_cores_.push_back(plan(core, base));
  }
  for (const Link& link : equations_.links) rigid_links_.push_back(plan(link.body, link.from));
  for (const SliderBlock& block : equations_.blocks) rigid_blocks_.push_back(plan(block.body, block.hinge));
}

void GroupSolver::place_arms(const Rigid& rigid, double cosine, double sine, double omega, double alpha,
                             Configuration& here) const {
  const PointState& base = here.points[rigid.base];
  for (const Arm& arm : rigid.arms) {
    const Vector2d way = turned(arm.local, cosine, sine);
    PointState& state = here.points[arm.point];
    state.position = base.position + way;
    state.velocity = base.velocity + omega * left_normal(way);
    state.acceleration = base.acceleration + alpha * left_normal(way) - omega * omega * way;
  }
}

Status GroupSolver::place(std::span<const DriveState> drives, int side, Configuration& here) {
  if (form_.placing == Placing::rotation) return place_crank(drives, here);
  if (form_.placing == Placing::triangle) return place_dyad(side, here);
  const Status status = find(drives, side, here);
  return status == Status::open ? status : finish(drives, here, status == Status::dead_centre);
}

Status GroupSolver::place(std::span<const DriveState> drives, const GroupPose& pose, Configuration& here) {
  if (!is_tracked()) return place(drives, pose.side, here);
  load(pose);
  return finish(drives, here, false);
}

Status GroupSolver::find(std::span<const DriveState> drives, int side, const Configuration& here) {
  switch (form_.placing) {
    case Placing::hinged:
      return find_hinged(drives, here);
    case Placing::crossing:
      return find_crossing(drives, side, here);
    case Placing::about_pivot:
      return find_about_pivot(drives, side, here);
    case Placing::rotation:
    case Placing::triangle:
      throw std::logic_error("cranks and triangles are placed with their rates at once");
    case Placing::platform:
    case Placing::iteration:
      break;
  }
  load(here);
  constexpr double kFarthest = 0.5;  // of the group's size: no guess of a step is so wrong
  return newton(drives, here, kFarthest) ? Status::ok : Status::open;
}

Status GroupSolver::place_crank(std::span<const DriveState> drives, Configuration& here) {
  const DriveState& drive = drives[condition(form_.angle).drive.value()];
  const std::size_t body = equations_.cores.front();
  const Rigid& rigid = rigid_cores_.front();
  const double cosine = std::cos(drive.value), sine = std::sin(drive.value);
  here.bodies[body] = {drive.value, drive.rate, drive.acceleration, cosine, sine};
  const Condition& hinge = condition(form_.hinge);
  if (hinge.a.point != rigid.base) {  // the pivot is not the body's first point
    const PointState& pivot = here.points[hinge.b.point];
    const Vector2d way = turned(-hinge.a.local, cosine, sine);
    here.points[rigid.base] = {
        pivot.position + way, pivot.velocity + drive.rate * left_normal(way),
        pivot.acceleration + drive.acceleration * left_normal(way) - drive.rate * drive.rate * way};
  }
  place_arms(rigid, cosine, sine, drive.rate, drive.acceleration, here);
  return Status::ok;
}

Status GroupSolver::place_dyad(int side, Configuration& here) {
  const Dyad& dyad = *form_.dyad;
  const PointState& p = here.points[dyad.p];
  const PointState& q = here.points[dyad.q];
  const Vector2d d = q.position - p.position;
  const double base = std::sqrt(d.squaredNorm());  // lengths have bounds that keep their squares numbers
  const Triangle shape = triangle(base, dyad.r1, dyad.r2);
  const double rounding = flat_within(std::max(
      {dyad.r1 + dyad.r2, p.position.lpNorm<Eigen::Infinity>(), q.position.lpNorm<Eigen::Infinity>()}));
  // P on Q: no C where r₁ ≠ r₂, and any direction of it where r₁ = r₂; neither gives a number. NaN ends here
  // too.
  if (!(base > rounding && shape.slack >= -rounding)) return Status::open;
  const bool flat = shape.slack <= rounding;
  const Vector2d direction = d * (1 / base);
  const Vector2d e1 = shape.along * direction + (side * shape.height) * left_normal(direction);
  PointState& c = here.points[dyad.c];
  c.position = p.position + e1;
  const Vector2d e2 = c.position - q.position;
  const double cross = side * shape.four_area / 2;
  regularity_ = cross * inverse_r1_ * inverse_r2_;
  double omega1 = kNaN, omega2 = kNaN, alpha1 = kNaN, alpha2 = kNaN;
  if (!flat) {
    const double inverse = 1 / cross;
    const Vector2d velocity = q.velocity - p.velocity;
    omega1 = e2.dot(velocity) * inverse;
    omega2 = e1.dot(velocity) * inverse;
    const Vector2d b = q.acceleration - p.acceleration + omega1 * omega1 * e1 - omega2 * omega2 * e2;
    alpha1 = e2.dot(b) * inverse;
    alpha2 = e1.dot(b) * inverse;
  }
  c.velocity = p.velocity + omega1 * left_normal(e1);
  c.acceleration = p.acceleration + alpha1 * left_normal(e1) - omega1 * omega1 * e1;
  for (std::size_t i = 0; i < 2; ++i) {
    const Link& link = equations_.links[i];
    const bool first = link.body == dyad.body1;
    const Vector2d bone = first ? e1 * inverse_r1_ : e2 * inverse_r2_;
    const double cosine = link.cosine * bone.x() + link.sine * bone.y();
    const double sine = link.cosine * bone.y() - link.sine * bone.x();
    const double omega = first ? omega1 : omega2, alpha = first ? alpha1 : alpha2;
    here.bodies[link.body] = {kNaN, omega, alpha, cosine, sine};
    place_arms(rigid_links_[i], cosine, sine, omega, alpha, here);
  }
  return flat ? Status::dead_centre : Status::ok;
}

Status GroupSolver::finish(std::span<const DriveState> drives, Configuration& here, bool flat) {
  const Vector2d zero = Vector2d::Zero();
  for (Core& core : cores_) {
    core.origin.velocity = core.origin.acceleration = zero;
    core.omega = core.alpha = 0;
  }
  for (PointState& point : free_) point.velocity = point.acceleration = zero;
  evaluate_jacobian(here);
  const auto apply = [&](bool second) {
    evaluate_rates(drives, here, second);
    const bool solved = solve();
    if (!second) measure_regularity();
    const auto part = [&](std::size_t k) { return solved ? solution_(static_cast<Eigen::Index>(k)) : kNaN; };
    std::size_t k = 0;
    for (Core& core : cores_) {
      (second ? core.origin.acceleration : core.origin.velocity) = {part(k), part(k + 1)};
      (second ? core.alpha : core.omega) = part(k + 2) / size_;
      k += 3;
    }
    for (PointState& point : free_) {
      (second ? point.acceleration : point.velocity) = {part(k), part(k + 1)};
      k += 2;
    }
  };
  apply(false);
  // Two modes that meet do so like square roots of the rounding.
  constexpr double kFlat = 1e-7;
  flat = flat || !(std::abs(regularity_) > (is_tracked() ? kFlat : 0));
  apply(true);
  if (flat) {
    const Vector2d nothing = Vector2d::Constant(kNaN);
    for (Core& core : cores_) {
      core.origin.velocity = core.origin.acceleration = nothing;
      core.omega = core.alpha = kNaN;
    }
    for (PointState& point : free_) point.velocity = point.acceleration = nothing;
  }
  for (std::size_t i = 0; i < cores_.size(); ++i) {
    const Core& core = cores_[i];
    const Rigid& rigid = rigid_cores_[i];
    here.bodies[rigid.body] = {kNaN, core.omega, core.alpha, core.cosine, core.sine};
    if (std::binary_search(group_.points.begin(), group_.points.end(), rigid.base))
      here.points[rigid.base] = core.origin;
    place_arms(rigid, core.cosine, core.sine, core.omega, core.alpha, here);
  }
  for (std::size_t i = 0; i < free_.size(); ++i) here.points[equations_.free_points[i]] = free_[i];
  for (std::size_t i = 0; i < equations_.links.size(); ++i) {
    const Link& link = equations_.links[i];
    const PointState& from = here.points[link.from];
    const PointState& to = here.points[link.to];
    const Vector2d e = to.position - from.position;
    const double squared = e.squaredNorm(), length = std::sqrt(squared);
    const Vector2d across = left_normal(e) / squared;
    const double omega = across.dot(to.velocity - from.velocity);
    const double alpha = across.dot(to.acceleration - from.acceleration);
    const double cosine = (link.cosine * e.x() + link.sine * e.y()) / length;
    const double sine = (link.cosine * e.y() - link.sine * e.x()) / length;
    here.bodies[link.body] = {kNaN, omega, alpha, cosine, sine};
    place_arms(rigid_links_[i], cosine, sine, omega, alpha, here);
  }
  for (std::size_t i = 0; i < equations_.blocks.size(); ++i) {
    const SliderBlock& block = equations_.blocks[i];
    const BodyState on = block.on ? here.bodies[*block.on] : BodyState{0, 0, 0, 1, 0};
    const double cosine = on.cosine * block.cosine - on.sine * block.sine;
    const double sine = on.sine * block.cosine + on.cosine * block.sine;
    here.bodies[block.body] = {kNaN, on.omega, on.alpha, cosine, sine};
    place_arms(rigid_blocks_[i], cosine, sine, on.omega, on.alpha, here);
  }
  return flat ? Status::dead_centre : Status::ok;
}

void GroupSolver::load(const Configuration& here) {
  for (std::size_t i = 0; i < cores_.size(); ++i) {
    const BodyState& body = here.bodies[equations_.cores[i]];
    cores_[i].origin.position = here.points[rigid_cores_[i].base].position;
    cores_[i].cosine = body.cosine;
    cores_[i].sine = body.sine;
  }
  for (std::size_t i = 0; i < free_.size(); ++i)
    free_[i].position = here.points[equations_.free_points[i]].position;
}

void GroupSolver::load(const GroupPose& pose) {
  for (std::size_t i = 0; i < cores_.size(); ++i) {
    cores_[i].origin.position = pose.cores[i].position;
    cores_[i].cosine = pose.cores[i].cosine;
    cores_[i].sine = pose.cores[i].sine;
  }
  for (std::size_t i = 0; i < free_.size(); ++i) free_[i].position = pose.points[i];
}

GroupPose GroupSolver::pose(int side) const {
  GroupPose pose;
  for (const Core& core : cores_) pose.cores.push_back({core.origin.position, core.cosine, core.sine});
  for (const PointState& point : free_) pose.points.push_back(point.position);
  pose.side = side;
  return pose;
}

}  // namespace oblique::mechanism
