// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <Eigen/Core>

// Not installed.
namespace oblique::patch {

/// The direction at an angle [rad]. At right angles a component is 0, and not the 6e-17 that the rounding of
/// π leaves: it becomes a weight that a schematic shows.
inline Eigen::Vector2d unit_vector(double angle) {
  constexpr double kRounding = 1e-15;
  const auto whole = [](double part) { return std::abs(part) < kRounding ? 0 : part; };
  return {whole(std::cos(angle)), whole(std::sin(angle))};
}

}  // namespace oblique::patch
