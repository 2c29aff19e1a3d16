// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>

namespace oblique::patch {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

inline mechanism::Mechanism shipped(const std::string& name) {
  return mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name +
                                   ".toml");
}

/// A patched diagram run to its end, and the program it became.
struct PatchedRun {
  explicit PatchedRun(const diagram::Diagram& diagram)
      : flat(diagram::flatten(diagram, library)),
        program(network::assemble(flat)),
        result(solve::run(program, flat, solve::options_of(diagram.run))) {}
  diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  diagram::FlatDiagram flat;
  network::Program program;
  solve::Run result;
};

inline const char* const kFourBar = R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5 }
CD = { points = ["C", "D"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
[sketch]
C = [3, 2.8]
)";

/// Largest distance of any moving point from its exact place [length unit].
inline double largest_error(const mechanism::Mechanism& mechanism, const solve::Run& analog) {
  const solve::Trajectory& table = analog.trajectory;
  std::vector<double> times;
  for (std::size_t r = 0; r < table.rows(); ++r) times.push_back(table.at(r, 0));
  const mechanism::Motion exact = mechanism::solve_motion(mechanism, times);
  double largest = 0;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (mechanism.points[p].fixed) continue;
    const auto x = table.find(mechanism.points[p].name + ".x"),
               y = table.find(mechanism.points[p].name + ".y");
    EXPECT_TRUE(x && y) << mechanism.points[p].name;
    for (std::size_t r = 0; r < table.rows(); ++r) {
      const Eigen::Vector2d& place = exact.configurations[r].points[p].position;
      largest = std::max(largest, std::hypot(table.at(r, *x) - place.x(), table.at(r, *y) - place.y()));
    }
  }
  return largest;
}

}  // namespace oblique::patch
