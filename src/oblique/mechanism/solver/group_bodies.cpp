// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/group_bodies.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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
  for (const std::size_t core : group.equations.cores) {
    const std::size_t base = mechanism.bodies[core].points.front().point;
    cores_.push_back(plan(core, base));
  }
  for (const Link& link : group.equations.links) links_.push_back(plan(link.body, link.from));
  for (const SliderBlock& block : group.equations.blocks) blocks_.push_back(plan(block.body, block.hinge));
}

void GroupBodies::place(const GroupState& state, Configuration& here) const {
  for (std::size_t i = 0; i < cores_.size(); ++i) {
    const GroupState::Core& core = state.cores[i];
    const RigidBody& rigid = cores_[i];
    here.bodies[rigid.body] = {kNaN, core.omega, core.alpha, core.cosine, core.sine};
    if (std::binary_search(group_.points.begin(), group_.points.end(), rigid.base))
      here.points[rigid.base] = core.origin;
    place_arms(rigid, core.cosine, core.sine, core.omega, core.alpha, here);
  }
  for (std::size_t i = 0; i < state.free.size(); ++i)
    here.points[group_.equations.free_points[i]] = state.free[i];
  for (std::size_t i = 0; i < group_.equations.links.size(); ++i) {
    const Link& link = group_.equations.links[i];
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
    place_arms(links_[i], cosine, sine, omega, alpha, here);
  }
  for (std::size_t i = 0; i < group_.equations.blocks.size(); ++i) {
    const SliderBlock& block = group_.equations.blocks[i];
    const BodyState on = block.on ? here.bodies[*block.on] : BodyState{0, 0, 0, 1, 0};
    const double cosine = on.cosine * block.cosine - on.sine * block.sine;
    const double sine = on.sine * block.cosine + on.cosine * block.sine;
    here.bodies[block.body] = {kNaN, on.omega, on.alpha, cosine, sine};
    place_arms(blocks_[i], cosine, sine, on.omega, on.alpha, here);
  }
}

}  // namespace oblique::mechanism
