// SPDX-License-Identifier: MIT
#include <oblique/text/even_point.h>

#include <cmath>

namespace oblique::text {

std::vector<double> even_point(int k, std::size_t dimensions) {
  double g = 2;
  for (int i = 0; i < 60; ++i) g = std::pow(1 + g, 1 / static_cast<double>(dimensions + 1));
  std::vector<double> point(dimensions);
  for (std::size_t i = 0; i < dimensions; ++i) {
    const double x = 0.5 + k * std::pow(1 / g, static_cast<double>(i + 1));
    point[i] = x - std::floor(x);
  }
  return point;
}

}  // namespace oblique::text
