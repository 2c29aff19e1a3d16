// SPDX-License-Identifier: MIT
#include <oblique/mechanism/triad/triad_closure.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace oblique::mechanism::triad {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kClosure = 1e-13;  // of the group's size
constexpr double kFar = 1e4;        // in sizes of the group: lines that meet there are parallel

void move(Pose& pose, const Vector3d& by) {
  pose.q += Complex(by[0], by[1]);
  pose.z = turned(pose.z, by[2]);
}

/// The step of least length that mends what can be mended: the part along a direction in which the platform
/// is free to first order, to `threshold`, is left out.
Vector3d shortest_step(const Matrix3d& jacobian, const Vector3d& residual, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Matrix3d> solver;
  solver.setThreshold(threshold);
  return -solver.compute(jacobian).solve(residual);
}

}  // namespace

Complex turned(Complex z, double delta) {
  const Complex turned = z * Complex(1, delta);
  return turned / modulus(turned);
}

Closure::Closure(const std::array<Condition, 3>& conditions, double rounding)
    : conditions_(conditions), rounding_(rounding) {
  for (const Condition& condition : conditions) {
    if (condition.kind == Leg::Kind::circle) shortest_ = std::min(shortest_, condition.length);
  }
}

/// The residuals of the conditions, and their derivatives by q_x, q_y and θ.
void Closure::differentiate(const Pose& pose, Vector3d& residual, Matrix3d& jacobian) const {
  for (int i = 0; i < 3; ++i) {
    const auto& [kind, local, anchor, normal, length] = conditions_[static_cast<std::size_t>(i)];
    const Complex arm = pose.z * local;
    Complex gradient;
    double by_angle = 0;
    if (kind == Leg::Kind::platform_line) {
      const Complex across = pose.z * normal;
      const Complex offset = anchor - pose.q;
      residual[i] = dot(across, offset) - dot(normal, local);
      gradient = -across;
      by_angle = dot(kQuarterTurn * across, offset);
    } else {
      const Complex offset = pose.q + arm - anchor;
      if (kind == Leg::Kind::circle) {  // (|p|² − l²)/2l is |p| − l as it goes to zero
        const double inverse = length > 0 ? 1 / length : 1;
        residual[i] = (std::norm(offset) - length * length) * inverse / 2;
        gradient = offset * inverse;
      } else {
        residual[i] = dot(normal, offset);
        gradient = normal;
      }
      by_angle = dot(gradient, kQuarterTurn * arm);
    }
    jacobian.row(i) << gradient.real(), gradient.imag(), by_angle;
  }
}

std::optional<Pose> Closure::polished(const Pose& guess) const {
  constexpr double kNear = 10 * kClosure;
  constexpr double kLost = 1e-4;      // a longer step from a pose that nearly closes is rounding over nothing
  constexpr double kDoubtful = 1e-2;  // as is this one where the determinant is small; the shortest step then
                                      // leads onto a curve of poses
  Pose pose = guess;
  Pose best = guess;
  double least = std::numeric_limits<double>::infinity();
  Vector3d residual;
  Matrix3d jacobian;
  for (int step = 0; step < 30; ++step) {
    differentiate(pose, residual, jacobian);
    const double error = residual.cwiseAbs().maxCoeff();
    const bool better = error < least;
    if (better) {
      least = error;
      best = pose;
    }
    if (error <= std::numeric_limits<double>::epsilon()) break;
    const Vector3d first = jacobian.row(0), second = jacobian.row(1), third = jacobian.row(2);
    const Vector3d a = second.cross(third), b = third.cross(first), c = first.cross(second);
    const double det = first.dot(a);
    if (!better && least < kClosure && std::abs(det) > 1e-6) break;
    Vector3d by = -(a * residual[0] + b * residual[1] + c * residual[2]) / det;
    const double longest_trusted = error < kNear ? kLost : kDoubtful;
    const bool lost = !(by.cwiseAbs().maxCoeff() < longest_trusted);
    if (lost && error < kClosure) {
      best.singular = true;
      break;
    }
    if (lost && (error < kNear || std::abs(det) < 1e-9)) by = shortest_step(jacobian, residual, 1e-9);
    const double longest = by.cwiseAbs().maxCoeff();
    if (!(longest < kFar)) break;
    const double stride = 0.5 * (1 + modulus(pose.q));
    if (longest > stride) by *= stride / longest;
    move(pose, by);
  }
  if (modulus(best.q) > kFar || least > kClosure + rounding(best)) return std::nullopt;
  return best;
}

/// To which a pose closes whatever is done. One far out has its own.
double Closure::rounding(const Pose& pose) const {
  return 8 * rounding_ * (1 + modulus(pose.q));
}

bool Closure::are_one(const Pose& a, const Pose& b) const {
  const Complex between = a.z + b.z;
  Pose midway{(a.q + b.q) / 2.0, between / modulus(between)};
  Vector3d residual;
  Matrix3d jacobian;
  differentiate(midway, residual, jacobian);
  if (residual.cwiseAbs().maxCoeff() > rounding(a)) {
    move(midway, shortest_step(jacobian, residual, 1e-6));
    differentiate(midway, residual, jacobian);
  }
  return residual.cwiseAbs().maxCoeff() <= rounding(a);
}

bool Closure::lies_on_curve(const Pose& pose) const {
  Vector3d residual;
  Matrix3d jacobian;
  differentiate(pose, residual, jacobian);
  Vector3d tangent = Vector3d::Zero();
  int redundant = 0;
  for (int i = 0; i < 3; ++i) {
    const Vector3d normal = jacobian.row((i + 1) % 3).cross(jacobian.row((i + 2) % 3));
    if (normal.squaredNorm() <= tangent.squaredNorm()) continue;
    tangent = normal;
    redundant = i;
  }
  const double area = tangent.norm();
  if (area == 0 || std::abs(jacobian.row(redundant).dot(tangent)) > 1e-4 * area) return false;
  tangent /= area;
  for (const double way : {0.1, -0.07}) {
    // Newton on the other two conditions, at a distance; at a dead centre the third then fails by its square
    Pose moved = pose;
    const double distance = way * shortest_;
    Vector3d done = Vector3d::Zero();
    for (int step = 0; step < 12; ++step) {
      differentiate(moved, residual, jacobian);
      residual[redundant] = tangent.dot(done) - distance;
      jacobian.row(redundant) = tangent.transpose();
      const Vector3d by = -jacobian.partialPivLu().solve(residual);
      if (!(by.cwiseAbs().maxCoeff() < 1)) return false;
      done += by;
      move(moved, by);
    }
    differentiate(moved, residual, jacobian);
    if (residual.cwiseAbs().maxCoeff() > 10 * kClosure + 64 * rounding_) return false;
  }
  return true;
}

}  // namespace oblique::mechanism::triad
