// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/solver/group_state.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// A body by the one of its points that is placed first; the arms lead to those that it carries.
struct RigidBody {
  struct Arm {
    std::size_t point;
    Eigen::Vector2d local;  ///< from the base, in the body's frame
  };
  std::size_t body;
  std::size_t base;  ///< index in Mechanism::points
  std::vector<Arm> arms;
};

/// Places the points that a body carries, once its base stands in `here`.
inline void place_arms(const RigidBody& rigid, double cosine, double sine, double omega, double alpha,
                       Configuration& here) {
  const PointState& base = here.points[rigid.base];
  for (const RigidBody::Arm& arm : rigid.arms) {
    const Eigen::Vector2d way = turned(arm.local, cosine, sine);
    PointState& state = here.points[arm.point];
    state.position = base.position + way;
    state.velocity = base.velocity + omega * left_normal(way);
    state.acceleration = base.acceleration + alpha * left_normal(way) - omega * omega * way;
  }
}

/// All bodies of a group, and what they carry. Each point is carried by one of them.
class GroupBodies {
 public:
  /// The group has to outlive it.
  GroupBodies(const Mechanism& mechanism, const Group& group);

  /// As the core bodies, the links and the slider blocks of GroupEquations.
  const std::vector<RigidBody>& cores() const { return cores_; }
  const std::vector<RigidBody>& links() const { return links_; }

  /// Writes all bodies and points of the group as its unknowns stand and move.
  void place(const GroupState& state, Configuration& here) const;

 private:
  const Group& group_;
  std::vector<RigidBody> cores_, links_, blocks_;
};

}  // namespace oblique::mechanism
