// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace oblique::testing {

// The four-bar of diagrams/mechanisms in closed form [m]: B on the crank of 1 m about (0, 0), D = (4, 0),
// |BC| = 3.5 m, |CD| = 3 m, C to the left of B → D.
inline constexpr double kCoupler = 3.5, kRocker = 3;
inline const Eigen::Vector2d kPivot(4, 0);

/// B.
inline Eigen::Vector2d crank_end(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// C.
inline Eigen::Vector2d rocker_end(double angle) {
  const Eigen::Vector2d d = kPivot - crank_end(angle);
  const double length = d.norm();
  const double along = (kCoupler * kCoupler - kRocker * kRocker + length * length) / (2 * length);
  const double across = std::sqrt(kCoupler * kCoupler - along * along);
  return crank_end(angle) + (along * d + across * Eigen::Vector2d(-d.y(), d.x())) / length;
}

/// C as servo amplifiers of gain μ at rest have it, each where its own equation says (docs/method.md), in
/// units of reach = 5 m, the longest |BD|, with w = 10 and m = 1/(w μ):
///
///     L² + m L = d²,   c (L + m) = dx,   s (L + m) = dy,
///     cos γ (L + m) = L²/(2a) + (a² − b²)/(2a),   sin²γ + m sin γ = 1 − cos²γ
inline Eigen::Vector2d rocker_end_at_rest(double angle, double gain) {
  const double reach = 5, m = 1 / (10 * gain), a = kCoupler / reach, b = kRocker / reach;
  const Eigen::Vector2d d = (kPivot - crank_end(angle)) / reach;
  const auto root = [](double half, double square) { return -half + std::sqrt(half * half + square); };
  const double length = root(m / 2, d.squaredNorm());
  const double c = d.x() / (length + m), s = d.y() / (length + m);
  const double cosine = (length * length / (2 * a) + (a * a - b * b) / (2 * a)) / (length + m);
  const double sine = root(m / 2, 1 - cosine * cosine);
  return crank_end(angle) + kCoupler * Eigen::Vector2d(c * cosine - s * sine, s * cosine + c * sine);
}

}  // namespace oblique::testing
