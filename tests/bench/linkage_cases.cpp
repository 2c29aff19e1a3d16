// SPDX-License-Identifier: MIT
#include "linkage_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace oblique::bench {
namespace {

HandLinkage::Step dyad(HandLinkage::Dyad made) {
  return {made, std::nullopt};
}
HandLinkage::Step carried(HandLinkage::Carried made) {
  return {std::nullopt, made};
}

}  // namespace

/// Points: 0 B, 1 D, 2 C, 3 M.
LinkageCase four_bar() {
  HandLinkage made;
  made.crank = 1.0 / 4;
  made.fixed = {{1, 1, 0}};
  made.steps = {dyad({2, 0, 1, 3.5 / 4, 3.0 / 4, 1, 1.25}), carried({3, 0, 2, 1.75 / 3.5, 1 / 3.5})};
  made.shown = {0, 2, 3};
  return {"four-bar", "four-bar", made, {"B", "C", "M"}, 1, 4};
}

/// Points: 0 B, 1 D, 2 C, 3 E, 4 F.
LinkageCase six_bar() {
  HandLinkage made;
  made.crank = 0.4;
  made.fixed = {{1, 1, 0}};
  made.steps = {dyad({2, 0, 1, 0.7, 0.75, 1, 1.4}), carried({3, 0, 2, 50.0 / 140, 0}),
                carried({4, 0, 2, 50.0 / 140, 45.0 / 140})};
  made.shown = {0, 2, 3, 4};
  return {"six-bar-above", "six-bar", made, {"B", "C", "E", "F"}, 100, 200};
}

/// Points: P1 … P6 are 0 … 5, Q1 … Q6 are 6 … 11, and O2 is 12; 1 machine unit is 200 mm.
LinkageCase jansen() {
  HandLinkage made;
  made.crank = 15.0 / 200;
  made.mirror = 6;
  made.fixed = {{12, -38.0 / 200, -7.8 / 200}};
  const double unit = 200, wide = 0.269, long_one = 0.361;
  const auto corner = [](double base, double from, double to) {  // left of the base, from its first end
    const double along = (base * base + from * from - to * to) / (2 * base);
    return std::array{along / base, std::sqrt(from * from - along * along) / base};
  };
  const auto upper = corner(41.5, 40.1, 55.8), lower = corner(36.7, 49, 65.7);
  for (const std::size_t leg : {0UL, 6UL}) {
    made.steps.push_back(dyad({leg + 1, leg, 12, 50 / unit, 41.5 / unit, -1, wide}));
    made.steps.push_back(carried({leg + 2, 12, leg + 1, upper[0], upper[1]}));
    made.steps.push_back(dyad({leg + 5, leg, 12, 61.9 / unit, 39.3 / unit, 1, wide}));
    made.steps.push_back(dyad({leg + 3, leg + 2, leg + 5, 39.4 / unit, 36.7 / unit, -1, long_one}));
    made.steps.push_back(carried({leg + 4, leg + 5, leg + 3, lower[0], lower[1]}));
  }
  made.shown = {0, 6, 1, 2, 5, 3, 4, 7, 8, 11, 9, 10};
  return {"jansen",
          "Jansen, both legs",
          made,
          {"P1", "Q1", "P2", "P3", "P6", "P4", "P5", "Q2", "Q3", "Q6", "Q4", "Q5"},
          2 * std::numbers::pi,
          unit};
}

/// Points: 0 A, 1 E, 2 O1, 3 B, 4 C, 5 D; the distance E–B is found by the loop that closes E–D.
LinkageCase class_three() {
  HandLinkage made;
  made.crank = 0.15;
  made.fixed = {{1, 0.73, 0.412}, {2, 0, 0.6}};
  made.steps = {dyad({3, 0, 1, 0.535, 0, -1, 0.989, true}),
                dyad({4, 3, 2, 0.5045260151865313, 0.9725, -1, 1.08}),
                carried({5, 3, 4, 0.5388259119650045, 0.37946406648686987})};
  made.loop = HandLinkage::Loop{5, 0.73, 0.412, 0.3785, 100};
  made.shown = {0, 3, 5, 4};
  return {"class-iii", "class III", made, {"A", "B", "D", "C"}, 1, 2};
}

double largest_error(const std::vector<double>& values, const std::vector<double>& finer) {
  double largest = values.size() == finer.size() ? 0 : INFINITY;
  for (std::size_t k = 0; k < std::min(values.size(), finer.size()); ++k)
    largest = std::max(largest, std::abs(values[k] - finer[k]));
  return largest;
}

std::vector<double> values_of(const solve::Trajectory& ours, const std::vector<std::string>& points) {
  std::vector<std::size_t> columns{0};
  for (const std::string& point : points) {
    columns.push_back(ours.find(point + ".x").value());
    columns.push_back(ours.find(point + ".y").value());
  }
  std::vector<double> values;
  for (std::size_t row = 0; row < ours.rows(); ++row) {
    for (const std::size_t column : columns) values.push_back(ours.at(row, column));
  }
  return values;
}

}  // namespace oblique::bench
