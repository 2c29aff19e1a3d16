// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/pose_search.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <oblique/mechanism/solver/newton.h>

namespace oblique::mechanism {

using Eigen::Vector2d;

GroupPoses search_poses(GroupSystem& system, std::span<const DriveState> drives, const Configuration& here,
                        const GroupPose* hint) {
  const GroupEquations& equations = system.equations();
  const double size = system.size();
  GroupState state(equations);
  GroupPoses found;
  found.complete = false;
  const auto is_new = [&](const GroupPose& pose) {
    constexpr double kSame = 1e-6;
    return std::none_of(found.poses.begin(), found.poses.end(), [&](const GroupPose& other) {
      double far = 0;
      for (std::size_t i = 0; const GroupPose::Platform& platform : pose.platforms) {
        const GroupPose::Platform& twin = other.platforms[i++];
        far = std::max(far, (platform.position - twin.position).norm());
        far = std::max(far, size * std::hypot(platform.cosine - twin.cosine, platform.sine - twin.sine));
      }
      for (std::size_t i = 0; const Vector2d& point : pose.points)
        far = std::max(far, (point - other.points[i++]).norm());
      return far < kSame * size;
    });
  };
  const auto attempt = [&](const GroupPose& guess) {
    state.load(guess);
    if (!close_by_newton(system, state, drives, here).closed) return;
    const GroupPose pose = state.pose(guess.side);
    if (is_new(pose)) found.poses.push_back(pose);
  };
  if (hint != nullptr) attempt(*hint);
  // the box of the known points, with the group's size around it
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Condition& c : equations.conditions) {
    for (const PointRef* point : {&c.a, &c.b}) {
      if (point->kind != PointRef::Kind::known || c.kind == Condition::Kind::orientation) continue;
      if (point == &c.b && c.kind != Condition::Kind::distance && c.kind != Condition::Kind::coincidence)
        continue;
      low = low.cwiseMin(here.points[point->point].position);
      high = high.cwiseMax(here.points[point->point].position);
    }
  }
  if (!(low.x() <= high.x())) low = high = Vector2d::Zero();
  low.array() -= size;
  high.array() += size;
  std::mt19937_64 random(20211121);
  const auto fraction = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto place_in_box = [&] {
    return Vector2d(low.x() + fraction() * (high.x() - low.x()), low.y() + fraction() * (high.y() - low.y()));
  };
  const int starts = 60 * static_cast<int>(equations.unknowns());
  for (int i = 0; i < starts; ++i) {
    GroupPose guess;
    guess.platforms.resize(equations.platforms.size());
    for (GroupPose::Platform& platform : guess.platforms) {
      const double angle = 2 * std::numbers::pi * fraction();
      platform = {place_in_box(), std::cos(angle), std::sin(angle)};
    }
    guess.points.resize(equations.free_points.size());
    for (Vector2d& point : guess.points) point = place_in_box();
    attempt(guess);
  }
  return found;
}

}  // namespace oblique::mechanism
