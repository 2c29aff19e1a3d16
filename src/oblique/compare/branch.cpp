// SPDX-License-Identifier: MIT
#include <oblique/compare/branch.h>

#include <algorithm>
#include <cmath>

#include <oblique/compare/patched_run.h>
#include <oblique/mechanism/solver/group_solver.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/solve/solve_error.h>

namespace oblique::compare {
namespace {

/// Poses that are farther apart than this part of the largest link are different ones: Newton's method leaves
/// 1e-12 of it.
constexpr double kApart = 1e-6;

/// Where a group stands in a configuration.
mechanism::GroupPose pose_in(const mechanism::Mechanism& mechanism, const mechanism::Group& group,
                             const mechanism::Configuration& here) {
  mechanism::GroupPose pose;
  for (const std::size_t platform : group.equations.platforms) {
    const mechanism::BodyState& body = here.bodies[platform];
    const std::size_t base = mechanism.bodies[platform].points.front().point;
    pose.platforms.push_back({here.points[base].position, body.cosine, body.sine});
  }
  for (const std::size_t point : group.equations.free_points)
    pose.points.push_back(here.points[point].position);
  return pose;
}

double distance(const mechanism::GroupPose& a, const mechanism::GroupPose& b, double size) {
  double far = 0;
  for (std::size_t i = 0; i < a.platforms.size(); ++i) {
    far = std::max(far, (a.platforms[i].position - b.platforms[i].position).norm());
    far = std::max(far, size * std::hypot(a.platforms[i].cosine - b.platforms[i].cosine,
                                          a.platforms[i].sine - b.platforms[i].sine));
  }
  for (std::size_t i = 0; i < a.points.size(); ++i) far = std::max(far, (a.points[i] - b.points[i]).norm());
  return far;
}

/// The exact configuration with all points, and so all links, where a run has them.
mechanism::Configuration analog_configuration(const mechanism::Mechanism& mechanism,
                                              const std::vector<PointOutputs>& outputs,
                                              const solve::Trajectory& analog,
                                              const mechanism::Configuration& exact, std::size_t row) {
  mechanism::Configuration there = exact;
  for (const PointOutputs& point : outputs) there.points[point.point].position = place_of(point, analog, row);
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    const std::vector<mechanism::BodyPoint>& points = mechanism.bodies[b].points;
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

std::optional<std::size_t> row_off_branch(const mechanism::Mechanism& mechanism,
                                          const mechanism::Structure& structure,
                                          const diagram::FlatDiagram& flat, const solve::Trajectory& analog,
                                          const mechanism::Motion& exact, const std::vector<double>& along) {
  constexpr double kLooked = 0.05;
  const double size = mechanism.largest_length();
  const std::vector<PointOutputs> outputs = point_outputs(mechanism, flat);
  std::vector<mechanism::GroupSolver> solvers;
  for (const mechanism::Group& group : structure.groups) solvers.emplace_back(mechanism, group);
  for (std::size_t row = 0; row < along.size(); ++row) {
    if (!(along[row] > kLooked * size)) continue;
    const mechanism::Configuration& here = exact.configurations[row];
    const mechanism::Configuration there = analog_configuration(mechanism, outputs, analog, here, row);
    for (std::size_t g = 0; g < solvers.size(); ++g) {
      const mechanism::Group& group = structure.groups[g];
      if (group.assur_class == 1) continue;
      const auto closed = solvers[g].close(exact.drives[row], here, pose_in(mechanism, group, there));
      if (closed && distance(*closed, pose_in(mechanism, group, here), size) > kApart * size) return row;
    }
  }
  return std::nullopt;
}

std::optional<double> drive_off_branch(const mechanism::Mechanism& mechanism,
                                       const commission::JudgedPatch& patched,
                                       const diagram::BlockLibrary& library) {
  constexpr std::int64_t kMostSteps = 100'000;  // half a second
  const mechanism::Mechanism within = patch::within_range(mechanism);
  patch::PatchOptions options = patched.options;
  options.samples = mechanism::rows_over_motion(within, CompareOptions().positions);
  const PatchedMechanism looked_at(patch_named(within, options), library);
  try {
    const RecordedRun recorded = run_recorded(looked_at, "", options.tolerance, {}, {}, kMostSteps);
    const mechanism::Motion exact = mechanism::solve_motion(within, options.samples);
    const Distances error = distances(within, looked_at.flat, recorded.run.trajectory, exact);
    const auto row = row_off_branch(within, mechanism::decompose(within), looked_at.flat,
                                    recorded.run.trajectory, exact, error.along);
    return row ? std::optional(exact.drives[*row].front().value) : std::nullopt;
  } catch (const solve::SolveError&) {
    return std::nullopt;
  }
}

}  // namespace oblique::compare
