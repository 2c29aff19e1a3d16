// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/group_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/solver/closed_forms.h>
#include <oblique/mechanism/solver/group_singularity.h>
#include <oblique/mechanism/solver/newton.h>
#include <oblique/mechanism/solver/pose_search.h>
#include <oblique/mechanism/triad/triangle.h>

namespace oblique::mechanism {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

GroupSolver::GroupSolver(const Mechanism& mechanism, const Group& group)
    : mechanism_(mechanism),
      group_(group),
      form_(group.form),
      equations_(group.equations),
      bodies_(mechanism, group),
      system_(mechanism, group.equations),
      state_(group.equations) {
  if (form_.dyad) {
    inverse_r1_ = 1 / form_.dyad->r1;
    inverse_r2_ = 1 / form_.dyad->r2;
  }
}

bool GroupSolver::is_tracked() const {
  switch (form_.placing) {
    case Placing::platform:
    case Placing::iteration:
      return true;
    case Placing::rotation:
    case Placing::triangle:
    case Placing::pinned:
    case Placing::crossing:
    case Placing::about_pivot:
      break;
  }
  return false;
}

bool GroupSolver::is_single() const {
  switch (form_.placing) {
    case Placing::rotation:
    case Placing::pinned:
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

Status GroupSolver::place(std::span<const DriveState> drives, int side, Configuration& here) {
  if (form_.placing == Placing::rotation) return place_crank(drives, here);
  if (form_.placing == Placing::triangle) return place_dyad(side, here);
  const Status status = find(drives, side, here);
  return status == Status::open ? status : finish(drives, here, status == Status::dead_centre);
}

Status GroupSolver::place(std::span<const DriveState> drives, const GroupPose& pose, Configuration& here) {
  if (!is_tracked()) return place(drives, pose.side, here);
  state_.load(pose);
  return finish(drives, here, false);
}

/// The unknowns of a group that is no crank and no triangle.
Status GroupSolver::find(std::span<const DriveState> drives, int side, const Configuration& here) {
  if (!is_tracked()) return find_by_closed_form(mechanism_, group_, drives, side, here, state_);
  state_.load(mechanism_, equations_, here);
  const Closing closing = close_by_newton(system_, state_, drives, here);
  correction_ = closing.correction;
  contraction_ = closing.contraction;
  return closing.closed ? Status::ok : Status::open;
}

Status GroupSolver::place_crank(std::span<const DriveState> drives, Configuration& here) {
  const DriveState& drive = drives[*equations_.conditions[*form_.angle].drive];
  const std::size_t body = equations_.platforms.front();
  const RigidBody& rigid = bodies_.platforms().front();
  const double cosine = std::cos(drive.value), sine = std::sin(drive.value);
  here.bodies[body] = {drive.value, drive.rate, drive.acceleration, cosine, sine};
  const Condition& revolute = equations_.conditions[*form_.revolute];
  if (revolute.a.point != rigid.base) {  // the pivot is not the link's first point
    const PointState& pivot = here.points[revolute.b.point];
    const Vector2d way = turned(-revolute.a.local, cosine, sine);
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
  const bool is_dead_centre = shape.slack <= rounding;
  const Vector2d direction = d * (1 / base);
  const Vector2d e1 = shape.along * direction + (side * shape.height) * left_normal(direction);
  PointState& c = here.points[dyad.c];
  c.position = p.position + e1;
  const Vector2d e2 = c.position - q.position;
  const double cross = side * shape.four_area / 2;
  determinant_ = cross * inverse_r1_ * inverse_r2_;
  double omega1 = kNaN, omega2 = kNaN, alpha1 = kNaN, alpha2 = kNaN;
  if (!is_dead_centre) {
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
    const BinaryLink& link = equations_.binary_links[i];
    const bool first = link.body == dyad.body1;
    const Vector2d bone = first ? e1 * inverse_r1_ : e2 * inverse_r2_;
    const double cosine = link.cosine * bone.x() + link.sine * bone.y();
    const double sine = link.cosine * bone.y() - link.sine * bone.x();
    const double omega = first ? omega1 : omega2, alpha = first ? alpha1 : alpha2;
    here.bodies[link.body] = {kNaN, omega, alpha, cosine, sine};
    place_arms(bodies_.binary_links()[i], cosine, sine, omega, alpha, here);
  }
  return is_dead_centre ? Status::dead_centre : Status::ok;
}

/// Rates of the unknowns, and all links and points by them.
Status GroupSolver::finish(std::span<const DriveState> drives, Configuration& here, bool is_dead_centre) {
  state_.stop();
  system_.evaluate_jacobian(state_, here);
  const auto apply = [&](bool second) {
    system_.evaluate_rates(state_, drives, here, second);
    const bool solved = system_.solve();
    if (!second) determinant_ = system_.normalised_determinant();
    const auto part = [&](Index k) { return solved ? system_.solution()(k) : kNaN; };
    Index k = 0;
    for (GroupState::Platform& platform : state_.platforms) {
      (second ? platform.origin.acceleration : platform.origin.velocity) = {part(k), part(k + 1)};
      (second ? platform.alpha : platform.omega) = part(k + 2) / system_.size();
      k += 3;
    }
    for (PointState& point : state_.free) {
      (second ? point.acceleration : point.velocity) = {part(k), part(k + 1)};
      k += 2;
    }
  };
  apply(false);
  is_dead_centre = is_dead_centre || !(std::abs(determinant_) > (is_tracked() ? kMeeting : 0));
  apply(true);
  if (is_dead_centre) {
    const Vector2d nothing = Vector2d::Constant(kNaN);
    for (GroupState::Platform& platform : state_.platforms) {
      platform.origin.velocity = platform.origin.acceleration = nothing;
      platform.omega = platform.alpha = kNaN;
    }
    for (PointState& point : state_.free) point.velocity = point.acceleration = nothing;
  }
  bodies_.place(state_, here);
  return is_dead_centre ? Status::dead_centre : Status::ok;
}

GroupPoses GroupSolver::poses(std::span<const DriveState> drives, const Configuration& here,
                              const GroupPose* hint) {
  GroupPoses found;
  switch (form_.placing) {
    case Placing::rotation:
      found.poses.push_back(state_.pose(0));
      break;
    case Placing::triangle: {
      Configuration copy = here;
      for (const int side : {+1, -1}) {
        const Status status = place_dyad(side, copy);
        if (status == Status::open) break;
        GroupPose pose;
        pose.points.push_back(copy.points[form_.dyad->c].position);
        pose.side = side;
        found.poses.push_back(std::move(pose));
        if (status == Status::dead_centre) break;
      }
      break;
    }
    case Placing::pinned:
    case Placing::crossing:
    case Placing::about_pivot: {
      const bool single = is_single();
      for (const int side : {+1, -1}) {
        const Status status = find(drives, single ? 0 : side, here);
        if (status == Status::open) break;
        found.poses.push_back(state_.pose(single ? 0 : side));
        if (status == Status::dead_centre || single) break;
      }
      break;
    }
    case Placing::platform:
      return platform_poses(mechanism_, group_, here);
    case Placing::iteration:
      return search_poses(system_, drives, here, hint);
  }
  return found;
}

std::optional<GroupPose> GroupSolver::close(std::span<const DriveState> drives, const Configuration& here,
                                            const GroupPose& guess) {
  state_.load(guess);
  if (!close_by_newton(system_, state_, drives, here).closed) return std::nullopt;
  return state_.pose(guess.side);
}

Singularity GroupSolver::singularity(std::span<const DriveState> drives, const Configuration& here,
                                     double seconds) {
  state_.load(mechanism_, equations_, here);
  return singularity_of(system_, state_, drives, here, seconds);
}

void GroupSolver::stand(std::span<const DriveState> drives, Configuration& here) {
  state_.load(mechanism_, equations_, here);
  finish(drives, here, true);
}

void GroupSolver::displace(const VectorXd& step, Configuration& here) const {
  Index k = 0;
  for (std::size_t i = 0; i < state_.platforms.size(); ++i, k += 3) {
    const std::size_t base = bodies_.platforms()[i].base;
    // two bodies that are pinned to each other may have the same base, which goes the way once
    const auto is_moved =
        std::any_of(bodies_.platforms().begin(), bodies_.platforms().begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const RigidBody& earlier) { return earlier.base == base; });
    if (!is_moved && std::binary_search(group_.points.begin(), group_.points.end(), base))
      here.points[base].position += step.segment<2>(k);
    BodyState& body = here.bodies[equations_.platforms[i]];
    const double angle = step(k + 2) / system_.size();
    const Vector2d way = turned({body.cosine, body.sine}, std::cos(angle), std::sin(angle));
    body.cosine = way.x();
    body.sine = way.y();
  }
  for (const std::size_t point : equations_.free_points) {
    here.points[point].position += step.segment<2>(k);
    k += 2;
  }
}

VectorXd GroupSolver::velocity(const Configuration& here) const {
  VectorXd rates(system_.jacobian().rows());
  Index k = 0;
  for (std::size_t i = 0; i < state_.platforms.size(); ++i, k += 3) {
    rates.segment<2>(k) = here.points[bodies_.platforms()[i].base].velocity;
    rates(k + 2) = system_.size() * here.bodies[equations_.platforms[i]].omega;
  }
  for (const std::size_t point : equations_.free_points) {
    rates.segment<2>(k) = here.points[point].velocity;
    k += 2;
  }
  return rates;
}

double GroupSolver::distance(const Configuration& here) const {
  Vector2d origin = Vector2d::Zero();
  for (std::size_t p = 0; p < mechanism_.points.size(); ++p) {
    if (!mechanism_.points[p].fixed) continue;
    origin = here.points[p].position;
    break;
  }
  double far = 0;
  for (const std::size_t point : group_.points)
    far = std::max(far, (here.points[point].position - origin).norm());
  return far / std::max(system_.size(), mechanism_.largest_length());
}

}  // namespace oblique::mechanism
