// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/solver/group_state.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// A link by the one of its points that is placed first; the arms lead to those that it carries.
struct RigidBody {
  struct Arm {
    std::size_t point;
    Eigen::Vector2d local;  ///< from the base, in the link's frame
  };
  std::size_t body;
  std::size_t base;  ///< index in Mechanism::points
  std::vector<Arm> arms;
};

/// Places the points that a link carries, once its base stands in `here`.
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

/// All links of a group, and what they carry. Each point is carried by one of them.
class GroupBodies {
 public:
  /// The group has to outlive it.
  GroupBodies(const Mechanism& mechanism, const Group& group);

  /// As the platform links, the binary links and the slider blocks of GroupEquations.
  const std::vector<RigidBody>& platforms() const { return platforms_; }
  const std::vector<RigidBody>& binary_links() const { return binary_links_; }

  /// Writes all links and points of the group as its unknowns stand and move.
  void place(const GroupState& state, Configuration& here) const;

 private:
  const Group& group_;
  std::vector<RigidBody> platforms_, binary_links_, blocks_;
};

}  // namespace oblique::mechanism
