// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/group_state.h>

#include <algorithm>

#include <oblique/mechanism/model/plane.h>

namespace oblique::mechanism {

using Eigen::Vector2d;

namespace {

/// A point of a body whose base moves like this.
PointState carried(const PointState& base, const Vector2d& way, double omega, double alpha) {
  return {base.position + way, base.velocity + omega * left_normal(way),
          base.acceleration + alpha * left_normal(way) - omega * omega * way};
}

}  // namespace

void GroupState::load(const Mechanism& mechanism, const GroupEquations& equations,
                      const Configuration& here) {
  for (std::size_t i = 0; i < cores.size(); ++i) {
    const std::size_t body = equations.cores[i];
    cores[i].origin.position = here.points[mechanism.bodies[body].points.front().point].position;
    cores[i].cosine = here.bodies[body].cosine;
    cores[i].sine = here.bodies[body].sine;
  }
  for (std::size_t i = 0; i < free.size(); ++i)
    free[i].position = here.points[equations.free_points[i]].position;
}

void GroupState::load(const GroupPose& pose) {
  for (std::size_t i = 0; i < cores.size(); ++i) {
    cores[i].origin.position = pose.cores[i].position;
    cores[i].cosine = pose.cores[i].cosine;
    cores[i].sine = pose.cores[i].sine;
  }
  for (std::size_t i = 0; i < free.size(); ++i) free[i].position = pose.points[i];
}

GroupPose GroupState::pose(int side) const {
  GroupPose pose;
  for (const Core& core : cores) pose.cores.push_back({core.origin.position, core.cosine, core.sine});
  for (const PointState& point : free) pose.points.push_back(point.position);
  pose.side = side;
  return pose;
}

void GroupState::stop() {
  for (Core& core : cores) {
    core.origin.velocity.setZero();
    core.origin.acceleration.setZero();
    core.omega = core.alpha = 0;
  }
  for (PointState& point : free) {
    point.velocity.setZero();
    point.acceleration.setZero();
  }
}

void GroupState::set_rates(const Eigen::VectorXd& rates, double size) {
  Eigen::Index k = 0;
  for (Core& core : cores) {
    core.origin.velocity = rates.segment<2>(k);
    core.omega = rates(k + 2) / size;
    core.origin.acceleration.setZero();
    core.alpha = 0;
    k += 3;
  }
  for (PointState& point : free) {
    point.velocity = rates.segment<2>(k);
    point.acceleration.setZero();
    k += 2;
  }
}

double GroupState::farthest(double least) const {
  double largest = least;
  for (const Core& core : cores) largest = std::max(largest, core.origin.position.lpNorm<Eigen::Infinity>());
  for (const PointState& point : free) largest = std::max(largest, point.position.lpNorm<Eigen::Infinity>());
  return largest;
}

PointState state_of(const PointRef& point, const GroupState& group, const Configuration& here) {
  if (point.kind == PointRef::Kind::known) return here.points[point.point];
  if (point.kind == PointRef::Kind::free) return group.free[point.member];
  const GroupState::Core& core = group.cores[point.member];
  return carried(core.origin, turned(point.local, core.cosine, core.sine), core.omega, core.alpha);
}

LineState state_of(const Mechanism& mechanism, const LineRef& line, const GroupState& group,
                   const Configuration& here) {
  if (line.kind == LineRef::Kind::fixed) {
    return {{line.point, Vector2d::Zero(), Vector2d::Zero()}, line.direction, 0, 0};
  }
  if (line.kind == LineRef::Kind::carried) {
    const GroupState::Core& core = group.cores[line.member];
    return {carried(core.origin, turned(line.point, core.cosine, core.sine), core.omega, core.alpha),
            turned(line.direction, core.cosine, core.sine), core.omega, core.alpha};
  }
  const BodyState& body = here.bodies[line.body];
  const PointState& base = here.points[mechanism.bodies[line.body].points.front().point];
  return {carried(base, turned(line.point, body.cosine, body.sine), body.omega, body.alpha),
          turned(line.direction, body.cosine, body.sine), body.omega, body.alpha};
}

}  // namespace oblique::mechanism
