// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

// What tests of `oblique animate` share.
namespace oblique::test {

inline const std::string kFourBar = "diagrams/mechanisms/four-bar.toml";
inline constexpr double kWidth = 760;  // of a picture at 100 % [px]

/// Columns of a CSV file by their names.
using Table = std::map<std::string, std::vector<double>>;

/// Where points of the four-bar linkage stand in a picture, told by its fixed pins A (0, 0) and D (4, 0).
struct Scale {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  double unit = 0;  ///< [px]

  explicit Scale(const std::string& svg) {
    const auto pin = [&](const std::string& point) {
      // Of a drawing the place itself, of an animation the shift around it.
      std::smatch match;
      const std::regex drawn("id=\"pin-" + point + R"rx("[^>]*cx="([^"]*)" cy="([^"]*)")rx");
      if (!std::regex_search(svg, match, drawn)) throw std::runtime_error("no pin " + point);
      const Eigen::Vector2d own(std::stod(match[1]), std::stod(match[2]));
      const std::string before = svg.substr(0, static_cast<std::size_t>(match.position()));
      const std::size_t shift = before.rfind("translate(");
      if (shift == std::string::npos) return own;
      std::istringstream numbers(before.substr(shift + 10));
      Eigen::Vector2d at;
      numbers >> at.x() >> at.y();
      return Eigen::Vector2d(at + own);
    };
    a = pin("A");
    unit = (pin("D") - a).norm() / 4;
  }
  Eigen::Vector2d pixel(const Eigen::Vector2d& place) const {
    return a + unit * Eigen::Vector2d(place.x(), -place.y());
  }
};

class Animations : public ::testing::Test {
 protected:
  Animations() : folder_(make_scratch_folder()) { std::filesystem::create_directories(folder_); }
  ~Animations() override { std::filesystem::remove_all(folder_); }

  static Outcome run(const std::string& command) { return run_command(command, OBLIQUE_SOURCE_DIR); }
  static bool can_draw() { return run("command -v rsvg-convert").status == 0; }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string bytes_of(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  bool is_empty() const { return std::filesystem::is_empty(folder_); }

  /// What a command writes to -o as CSV.
  Table table_of(const std::string& command) const {
    const Outcome outcome = run(command + " -o " + file("table.csv"));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::istringstream lines(bytes_of("table.csv"));
    std::string line;
    std::getline(lines, line);
    std::vector<std::string> names;
    std::istringstream header(line);
    for (std::string name; std::getline(header, name, ',');) names.push_back(name.substr(0, name.find(' ')));
    Table table;
    while (std::getline(lines, line)) {
      std::istringstream fields(line);
      for (const std::string& name : names) {
        std::string field;
        std::getline(fields, field, ',');
        table[name].push_back(std::strtod(field.c_str(), nullptr));
      }
    }
    return table;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace oblique::test
