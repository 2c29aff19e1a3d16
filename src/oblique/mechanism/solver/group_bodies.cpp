// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/group_bodies.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

GroupBodies::GroupBodies(const Mechanism& mechanism, const Group& group) : group_(group) {
  std::vector<bool> done(mechanism.points.size(), true);
  for (const std::size_t point : group.points) done[point] = false;
  for (const std::size_t point : group.equations.free_points) done[point] = true;
  const auto plan = [&](std::size_t body, std::size_t base) {
    RigidBody rigid{body, base, {}};
    done[base] = true;
    const Vector2d& origin = mechanism.bodies[body].find(base)->local;
    for (const BodyPoint& p : mechanism.bodies[body].points) {
      if (done[p.point]) continue;
      done[p.point] = true;
      rigid.arms.push_back({p.point, p.local - origin});
    }
    return rigid;
  };
  for (const std::size_t platform : group.equations.platforms) {
    const std::size_t base = mechanism.bodies[platform].points.front().point;
    platforms_.push_back(plan(platform, base));
  }
  for (const BinaryLink& link : group.equations.binary_links)
    binary_links_.push_back(plan(link.body, link.from));
  for (const SliderBlock& block : group.equations.blocks) blocks_.push_back(plan(block.body, block.revolute));
}

void GroupBodies::place(const GroupState& state, Configuration& here) const {
  for (std::size_t i = 0; i < platforms_.size(); ++i) {
    const GroupState::Platform& platform = state.platforms[i];
    const RigidBody& rigid = platforms_[i];
    here.bodies[rigid.body] = {kUnknown, platform.omega, platform.alpha, platform.cosine, platform.sine};
    if (std::binary_search(group_.points.begin(), group_.points.end(), rigid.base))
      here.points[rigid.base] = platform.origin;
    place_arms(rigid, platform.cosine, platform.sine, platform.omega, platform.alpha, here);
  }
  for (std::size_t i = 0; i < state.free.size(); ++i)
    here.points[group_.equations.free_points[i]] = state.free[i];
  for (std::size_t i = 0; i < group_.equations.binary_links.size(); ++i) {
    const BinaryLink& link = group_.equations.binary_links[i];
    const PointState& from = here.points[link.from];
    const PointState& to = here.points[link.to];
    const Vector2d e = to.position - from.position;
    const double squared = e.squaredNorm(), length = std::sqrt(squared);
    const Vector2d across = left_normal(e) / squared;
    const double omega = across.dot(to.velocity - from.velocity);
    const double alpha = across.dot(to.acceleration - from.acceleration);
    const double cosine = (link.cosine * e.x() + link.sine * e.y()) / length;
    const double sine = (link.cosine * e.y() - link.sine * e.x()) / length;
    here.bodies[link.body] = {kUnknown, omega, alpha, cosine, sine};
    place_arms(binary_links_[i], cosine, sine, omega, alpha, here);
  }
  for (std::size_t i = 0; i < group_.equations.blocks.size(); ++i) {
    const SliderBlock& block = group_.equations.blocks[i];
    const BodyState on = block.on ? here.bodies[*block.on] : BodyState{0, 0, 0, 1, 0};
    const double cosine = on.cosine * block.cosine - on.sine * block.sine;
    const double sine = on.sine * block.cosine + on.cosine * block.sine;
    here.bodies[block.body] = {kUnknown, on.omega, on.alpha, cosine, sine};
    place_arms(blocks_[i], cosine, sine, on.omega, on.alpha, here);
  }
}

}  // namespace oblique::mechanism
