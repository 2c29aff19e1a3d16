// SPDX-License-Identifier: MIT
#include <oblique/synthesis/spread_point.h>

#include <cmath>

namespace oblique {

Eigen::VectorXd spread_point(Eigen::Index dimensions, int k) {
  double g = 2;
  for (int i = 0; i < 60; ++i) g = std::pow(1 + g, 1 / static_cast<double>(dimensions + 1));
  Eigen::VectorXd point(dimensions);
  for (Eigen::Index i = 0; i < dimensions; ++i) {
    const double x = 0.5 + k * std::pow(1 / g, static_cast<double>(i + 1));
    point[i] = x - std::floor(x);
  }
  return point;
}

}  // namespace oblique
