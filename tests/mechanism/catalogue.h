// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

namespace oblique::mechanism {

inline std::filesystem::path catalogue_folder() {
  return std::filesystem::path(OBLIQUE_SOURCE_DIR) / "diagrams" / "mechanisms";
}

/// Names of the shipped mechanisms, "four-bar" …, in alphabetical order.
inline std::vector<std::string> catalogue_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(catalogue_folder())) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A mechanism with its motion, asked by name.
struct MovingMechanism {
  Mechanism mechanism;
  Motion motion;

  explicit MovingMechanism(Mechanism read, int positions = 361)
      : mechanism(std::move(read)), motion(solve_motion(mechanism, positions)) {}
  explicit MovingMechanism(const std::string& name)
      : MovingMechanism(read_mechanism(catalogue_folder() / (name + ".toml"))) {}

  std::size_t rows() const { return motion.times.size(); }
  double time(std::size_t row) const { return motion.times[row]; }
  const auto& drive(std::size_t row) const { return motion.drives[row].front(); }
  const auto& point(const std::string& name, std::size_t row) const {
    return motion.configurations[row].points[mechanism.find_point(name).value()];
  }
  const auto& body(const std::string& name, std::size_t row) const {
    return motion.configurations[row].bodies[mechanism.find_body(name).value()];
  }
  const auto& slide(const std::string& name, std::size_t row) const {
    return motion.configurations[row].slides[mechanism.find_slide(name).value()];
  }
};

}  // namespace oblique::mechanism
