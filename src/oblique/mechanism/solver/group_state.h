// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/solver/group_equations.h>

namespace oblique::mechanism {

/// Where the unknowns of a group stand, and how they move, in the order of GroupEquations. As a vector they
/// are x, y and angle of each platform link, x and y of each free point, angles as lengths on the group's
/// size.
struct GroupState {
  struct Platform {
    PointState origin;
    double cosine, sine, omega, alpha;
  };
  std::vector<Platform> platforms;
  std::vector<PointState> free;

  explicit GroupState(const GroupEquations& equations)
      : platforms(equations.platforms.size()), free(equations.free_points.size()) {}

  /// Takes the pose that stands in a configuration, or a pose. Rates stay as they are.
  void load(const Mechanism& mechanism, const GroupEquations& equations, const Configuration& here);
  void load(const GroupPose& pose);

  GroupPose pose(int side) const;

  /// Sets all rates to zero.
  void stop();

  /// Sets the velocities to this vector, and the accelerations to zero.
  void set_rates(const Eigen::VectorXd& rates, double size);

  /// The largest coordinate, or `least` [length unit].
  double farthest(double least) const;
};

/// A line that moves.
struct LineState {
  PointState at;
  Eigen::Vector2d direction;
  double omega, alpha;
};

/// Where a point or a line of a condition is, of a group whose unknowns stand as in `group`.
PointState state_of(const PointRef& point, const GroupState& group, const Configuration& here);
LineState state_of(const Mechanism& mechanism, const LineRef& line, const GroupState& group,
                   const Configuration& here);

/// All ways to put a group together.
struct GroupPoses {
  std::vector<GroupPose> poses;
  bool complete = true;  ///< false: found by a search, so these are at least some
  bool movable = false;  ///< its conditions depend on each other: it has a whole curve of poses
};

}  // namespace oblique::mechanism
