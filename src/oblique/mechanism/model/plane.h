// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>

namespace oblique::mechanism {

inline constexpr double kTurn = 2 * std::numbers::pi;  ///< [rad]

/// v turned by 90° to the left.
inline Eigen::Vector2d left_normal(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

/// v turned by the angle of this cosine and sine.
inline Eigen::Vector2d turned(const Eigen::Vector2d& v, double cosine, double sine) {
  return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y()};
}

/// v turned by an angle [rad].
inline Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle) {
  return turned(v, std::cos(angle), std::sin(angle));
}

/// a.x b.y − a.y b.x: positive where b lies to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace oblique::mechanism
