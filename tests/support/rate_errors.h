// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/solve/run.h>

namespace oblique::test {

/// Largest errors of all moving points, each in parts of the largest exact value of its kind.
struct RateErrors {
  double position = 0, velocity = 0, acceleration = 0;
};

/// Holds a run whose outputs have the names of `solve`'s columns against the exact motion at its times.
inline RateErrors rate_errors(const mechanism::Mechanism& mechanism, const solve::Trajectory& table) {
  std::vector<double> times;
  for (std::size_t r = 0; r < table.rows(); ++r) times.push_back(table.at(r, 0));
  const mechanism::Motion exact = mechanism::solve_motion(mechanism, times);
  const auto error_of = [&](const std::string& part, auto value_of) {
    double largest_error = 0, largest = 0;
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      const mechanism::Point& point = mechanism.points[p];
      if (point.fixed) continue;
      const auto x = table.find(point.name + "." + part + "x"), y = table.find(point.name + "." + part + "y");
      EXPECT_TRUE(x && y) << point.name << "." << part;
      if (!x || !y) continue;
      for (std::size_t r = 0; r < table.rows(); ++r) {
        const Eigen::Vector2d value = value_of(exact.configurations[r].points[p]);
        const Eigen::Vector2d shown(table.at(r, *x), table.at(r, *y));
        largest_error = std::max(largest_error, (shown - value).norm());
        largest = std::max(largest, value.norm());
      }
    }
    return largest_error / largest;
  };
  return {error_of("", [](const mechanism::PointState& p) { return p.position; }),
          error_of("v", [](const mechanism::PointState& p) { return p.velocity; }),
          error_of("a", [](const mechanism::PointState& p) { return p.acceleration; })};
}

}  // namespace oblique::test
