// SPDX-License-Identifier: MIT
#include <oblique/compare/branch.h>

#include <algorithm>
#include <cmath>

#include <oblique/compare/patched_run.h>
#include <oblique/mechanism/group_solver.h>

namespace oblique {
namespace {

/// Poses that are farther apart than this part of the largest link are different ones: Newton's method leaves
/// 1e-12 of it.
constexpr double kApart = 1e-6;

/// Where a group stands in a configuration.
GroupPose pose_in(const Mechanism& mechanism, const Group& group, const Configuration& here) {
  GroupPose pose;
  for (const std::size_t core : group.equations.cores) {
    const BodyState& body = here.bodies[core];
    const std::size_t base = mechanism.bodies[core].points.front().point;
    pose.cores.push_back({here.points[base].position, body.cosine, body.sine});
  }
  for (const std::size_t point : group.equations.free_points)
    pose.points.push_back(here.points[point].position);
  pose.side = group.side;
  return pose;
}

double distance(const GroupPose& a, const GroupPose& b, double size) {
  double far = 0;
  for (std::size_t i = 0; i < a.cores.size(); ++i) {
    far = std::max(far, (a.cores[i].position - b.cores[i].position).norm());
    far = std::max(
        far, size * std::hypot(a.cores[i].cosine - b.cores[i].cosine, a.cores[i].sine - b.cores[i].sine));
  }
  for (std::size_t i = 0; i < a.points.size(); ++i) far = std::max(far, (a.points[i] - b.points[i]).norm());
  return far;
}

/// The exact configuration with all points, and so all bodies, where a run has them.
Configuration analog_configuration(const Mechanism& mechanism, const std::vector<PointOutputs>& outputs,
                                   const Trajectory& analog, const Configuration& exact, std::size_t row) {
  Configuration there = exact;
  for (const PointOutputs& point : outputs) there.points[point.point].position = place_of(point, analog, row);
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    const std::vector<BodyPoint>& points = mechanism.bodies[b].points;
    const Eigen::Vector2d way =
        there.points[points[1].point].position - there.points[points[0].point].position;
    const double length = way.norm();
    if (!(length > 0)) continue;
    there.bodies[b].cosine = way.x() / length;
    there.bodies[b].sine = way.y() / length;
  }
  return there;
}

}  // namespace

std::optional<std::size_t> row_off_branch(const Mechanism& mechanism, const Structure& structure,
                                          const FlatDiagram& flat, const Trajectory& analog,
                                          const Motion& exact, const std::vector<double>& along) {
  constexpr double kLooked = 0.05;
  const double size = mechanism.largest_length();
  const std::vector<PointOutputs> outputs = point_outputs(mechanism, flat);
  std::vector<GroupSolver> solvers;
  for (const Group& group : structure.groups) solvers.emplace_back(mechanism, group);
  for (std::size_t row = 0; row < along.size(); ++row) {
    if (!(along[row] > kLooked * size)) continue;
    const Configuration& here = exact.configurations[row];
    const Configuration there = analog_configuration(mechanism, outputs, analog, here, row);
    for (std::size_t g = 0; g < solvers.size(); ++g) {
      const Group& group = structure.groups[g];
      if (group.assur_class == 1) continue;
      const auto closed = solvers[g].close(exact.drives[row], here, pose_in(mechanism, group, there));
      if (closed && distance(*closed, pose_in(mechanism, group, here), size) > kApart * size) return row;
    }
  }
  return std::nullopt;
}

}  // namespace oblique
