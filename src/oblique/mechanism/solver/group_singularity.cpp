// SPDX-License-Identifier: MIT
// The part of GroupSolver that looks at a pose where modes meet.
#include <algorithm>
#include <cmath>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/solver/group_solver.h>
#include <oblique/mechanism/structure/singular_values.h>
#include <oblique/mechanism/triad/triangle.h>

namespace oblique::mechanism {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Rates of the unknowns, without second ones.
void GroupSolver::set_rates(const VectorXd& rates) {
  Index k = 0;
  for (Core& core : cores_) {
    core.origin.velocity = rates.segment<2>(k);
    core.omega = rates(k + 2) / size_;
    core.origin.acceleration.setZero();
    core.alpha = 0;
    k += 3;
  }
  for (PointState& point : free_) {
    point.velocity = rates.segment<2>(k);
    point.acceleration.setZero();
    k += 2;
  }
}

Singularity GroupSolver::singularity(std::span<const DriveState> drives, const Configuration& here,
                                     double seconds) {
  load(here);
  Singularity result;
  const Index n = jacobian_.rows();
  set_rates(VectorXd::Zero(n));
  evaluate_jacobian(here);
  const SingularDecomposition svd = singular_decomposition(jacobian_);
  const VectorXd u = svd.u.col(n - 1);
  result.sigma = svd.values(n - 1);
  result.along = svd.v.col(n - 1);
  evaluate_rates(drives, here, false);  // right_ = −∂g/∂t
  result.drive = -u.dot(right_);
  VectorXd parts = svd.u.transpose() * right_;
  parts.head(n - 1).array() /= svd.values.head(n - 1).array();
  parts(n - 1) = 0;
  result.drift = svd.v * parts;
  // u·g̈ on the way p + λ v is C + 2 B λ + A λ²
  const double most = std::max(result.drift.norm(), size_ / seconds);
  const auto curvature = [&](double lambda) {
    set_rates(result.drift + lambda * result.along);
    evaluate_rates(drives, here, true);
    return -u.dot(right_);
  };
  const double still = curvature(0), plus = curvature(most), minus = curvature(-most);
  result.tt = still;
  result.st = (plus - minus) / (4 * most);
  result.ss = (plus + minus - 2 * still) / (2 * most * most);
  double largest = size_;
  for (const Core& core : cores_) largest = std::max(largest, core.origin.position.lpNorm<Eigen::Infinity>());
  for (const PointState& point : free_) largest = std::max(largest, point.position.lpNorm<Eigen::Infinity>());
  result.rounding = flat_within(largest);
  result.size = size_;
  result.seconds = seconds;
  return result;
}

void GroupSolver::stand(std::span<const DriveState> drives, Configuration& here) {
  load(here);
  finish(drives, here, true);
}

void GroupSolver::displace(const VectorXd& step, Configuration& here) const {
  Index k = 0;
  for (std::size_t i = 0; i < cores_.size(); ++i, k += 3) {
    const std::size_t base = rigid_cores_[i].base;
    if (std::binary_search(group_.points.begin(), group_.points.end(), base))
      here.points[base].position += step.segment<2>(k);
    BodyState& body = here.bodies[equations_.cores[i]];
    const double angle = step(k + 2) / size_;
    const Vector2d way = turned({body.cosine, body.sine}, std::cos(angle), std::sin(angle));
    body.cosine = way.x();
    body.sine = way.y();
  }
  for (const std::size_t point : equations_.free_points) {
    here.points[point].position += step.segment<2>(k);
    k += 2;
  }
}

VectorXd GroupSolver::velocity(const Configuration& here) const {
  VectorXd rates(jacobian_.rows());
  Index k = 0;
  for (std::size_t i = 0; i < cores_.size(); ++i, k += 3) {
    rates.segment<2>(k) = here.points[rigid_cores_[i].base].velocity;
    rates(k + 2) = size_ * here.bodies[equations_.cores[i]].omega;
  }
  for (const std::size_t point : equations_.free_points) {
    rates.segment<2>(k) = here.points[point].velocity;
    k += 2;
  }
  return rates;
}

double GroupSolver::distance(const Configuration& here) const {
  Vector2d origin = Vector2d::Zero();
  for (std::size_t p = 0; p < mechanism_.points.size(); ++p) {
    if (!mechanism_.points[p].fixed) continue;
    origin = here.points[p].position;
    break;
  }
  double far = 0;
  for (const std::size_t point : group_.points)
    far = std::max(far, (here.points[point].position - origin).norm());
  return far / std::max(size_, mechanism_.largest_length());
}

}  // namespace oblique::mechanism
