// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/group_state.h>

#include <algorithm>

#include <oblique/mechanism/model/plane.h>

namespace oblique::mechanism {

using Eigen::Vector2d;

namespace {

/// A point of a link whose base moves like this.
PointState carried(const PointState& base, const Vector2d& way, double omega, double alpha) {
  return {base.position + way, base.velocity + omega * left_normal(way),
          base.acceleration + alpha * left_normal(way) - omega * omega * way};
}

}  // namespace

void GroupState::load(const Mechanism& mechanism, const GroupEquations& equations,
                      const Configuration& here) {
  for (std::size_t i = 0; i < platforms.size(); ++i) {
    const std::size_t body = equations.platforms[i];
    platforms[i].origin.position = here.points[mechanism.bodies[body].points.front().point].position;
    platforms[i].cosine = here.bodies[body].cosine;
    platforms[i].sine = here.bodies[body].sine;
  }
  for (std::size_t i = 0; i < free.size(); ++i)
    free[i].position = here.points[equations.free_points[i]].position;
}

void GroupState::load(const GroupPose& pose) {
  for (std::size_t i = 0; i < platforms.size(); ++i) {
    platforms[i].origin.position = pose.platforms[i].position;
    platforms[i].cosine = pose.platforms[i].cosine;
    platforms[i].sine = pose.platforms[i].sine;
  }
  for (std::size_t i = 0; i < free.size(); ++i) free[i].position = pose.points[i];
}

GroupPose GroupState::pose(int side) const {
  GroupPose pose;
  for (const Platform& platform : platforms)
    pose.platforms.push_back({platform.origin.position, platform.cosine, platform.sine});
  for (const PointState& point : free) pose.points.push_back(point.position);
  pose.side = side;
  return pose;
}

void GroupState::stop() {
  for (Platform& platform : platforms) {
    platform.origin.velocity.setZero();
    platform.origin.acceleration.setZero();
    platform.omega = platform.alpha = 0;
  }
  for (PointState& point : free) {
    point.velocity.setZero();
    point.acceleration.setZero();
  }
}

void GroupState::set_rates(const Eigen::VectorXd& rates, double size) {
  Eigen::Index k = 0;
  for (Platform& platform : platforms) {
    platform.origin.velocity = rates.segment<2>(k);
    platform.omega = rates(k + 2) / size;
    platform.origin.acceleration.setZero();
    platform.alpha = 0;
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
  for (const Platform& platform : platforms)
    largest = std::max(largest, platform.origin.position.lpNorm<Eigen::Infinity>());
  for (const PointState& point : free) largest = std::max(largest, point.position.lpNorm<Eigen::Infinity>());
  return largest;
}

PointState state_of(const PointRef& point, const GroupState& group, const Configuration& here) {
  if (point.kind == PointRef::Kind::known) return here.points[point.point];
  if (point.kind == PointRef::Kind::free) return group.free[point.member];
  const GroupState::Platform& platform = group.platforms[point.member];
  return carried(platform.origin, turned(point.local, platform.cosine, platform.sine), platform.omega,
                 platform.alpha);
}

LineState state_of(const Mechanism& mechanism, const LineRef& line, const GroupState& group,
                   const Configuration& here) {
  if (line.kind == LineRef::Kind::fixed) {
    return {{line.point, Vector2d::Zero(), Vector2d::Zero()}, line.direction, 0, 0};
  }
  if (line.kind == LineRef::Kind::carried) {
    const GroupState::Platform& platform = group.platforms[line.member];
    return {carried(platform.origin, turned(line.point, platform.cosine, platform.sine), platform.omega,
                    platform.alpha),
            turned(line.direction, platform.cosine, platform.sine), platform.omega, platform.alpha};
  }
  const BodyState& body = here.bodies[line.body];
  const PointState& base = here.points[mechanism.bodies[line.body].points.front().point];
  return {carried(base, turned(line.point, body.cosine, body.sine), body.omega, body.alpha),
          turned(line.direction, body.cosine, body.sine), body.omega, body.alpha};
}

}  // namespace oblique::mechanism
