// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/group_singularity.h>

#include <algorithm>

#include <oblique/mechanism/structure/singular_values.h>
#include <oblique/mechanism/triad/triangle.h>

namespace oblique::mechanism {

using Eigen::Index;
using Eigen::VectorXd;

Singularity singularity_of(GroupSystem& system, GroupState& state, std::span<const DriveState> drives,
                           const Configuration& here, double seconds) {
  Singularity result;
  const double size = system.size();
  const Index n = system.jacobian().rows();
  state.stop();
  system.evaluate_jacobian(state, here);
  const SingularDecomposition svd = singular_decomposition(system.jacobian());
  const VectorXd u = svd.u.col(n - 1);
  result.sigma = svd.values(n - 1);
  result.along = svd.v.col(n - 1);
  system.evaluate_rates(state, drives, here, false);  // right = −∂g/∂t
  result.drive = -u.dot(system.right());
  VectorXd parts = svd.u.transpose() * system.right();
  parts.head(n - 1).array() /= svd.values.head(n - 1).array();
  parts(n - 1) = 0;
  result.drift = svd.v * parts;
  // u·g̈ on the way p + λ v is C + 2 B λ + A λ²
  const double most = std::max(result.drift.norm(), size / seconds);
  const auto curvature = [&](double lambda) {
    state.set_rates(result.drift + lambda * result.along, size);
    system.evaluate_rates(state, drives, here, true);
    return -u.dot(system.right());
  };
  const double still = curvature(0), plus = curvature(most), minus = curvature(-most);
  result.tt = still;
  result.st = (plus - minus) / (4 * most);
  result.ss = (plus + minus - 2 * still) / (2 * most * most);
  result.rounding = flat_within(state.farthest(size));
  result.size = size;
  result.seconds = seconds;
  return result;
}

}  // namespace oblique::mechanism
