// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

// A four-bar linkage by plain trigonometry, which shares no code with the library.
namespace oblique::test {

/// Crank from the origin, coupler with the point F, rocker to (frame, 0).
struct FourBar {
  double crank = 80;
  double coupler = 140;
  double rocker = 150;
  double frame = 200;
  double along = 50;  ///< of F along the coupler
  double left = 45;   ///< of F to the coupler's left

  /// The open assembly: C left of B → D. Not-a-number where it does not close.
  Eigen::Vector2d point(double angle) const {
    const double bx = crank * std::cos(angle), by = crank * std::sin(angle);
    const double diagonal = std::hypot(frame - bx, by);
    const double gamma =
        std::acos((coupler * coupler + diagonal * diagonal - rocker * rocker) / (2 * coupler * diagonal));
    const double theta = std::atan2(-by, frame - bx) + gamma;
    return {bx + along * std::cos(theta) - left * std::sin(theta),
            by + along * std::sin(theta) + left * std::cos(theta)};
  }

  /// Grashof with the crank or the frame as the shortest link: the crank turns fully.
  bool turns() const {
    return crank + frame < coupler + rocker && std::abs(frame - crank) > std::abs(coupler - rocker);
  }

  std::string text(const std::string& sketch = "[128, 132]") const {
    return fmt::format(R"(# a comment → that stays
format = "oblique-mechanism/1"
title  = "Four-bar"
[units]
length = "mm"
[frame]
A = [0, 0]
D = [{}, 0]
[bodies]
AB  = {{ points = ["A", "B"], length = {} }}   # the crank
BCF = {{ points = ["B", "C"], length = {}, marks = {{ F = [{}, {}] }} }}
CD  = {{ points = ["C", "D"], length = "{} mm" }}
[drives]
crank = {{ turns = "AB", about = "A", speed = "100 rad/s" }}
[sketch]
C = {}
)",
                       frame, crank, coupler, along, left, rocker, sketch);
  }
};

/// `n` angles over a turn, none of which is a row of a table in whole degrees.
inline std::vector<double> angles_of_a_turn(std::size_t n) {
  std::vector<double> angles;
  for (std::size_t k = 0; k < n; ++k) {
    angles.push_back(2 * std::numbers::pi * (static_cast<double>(k) + 0.3) / static_cast<double>(n));
  }
  return angles;
}

/// Small numbers without a pattern, the same on every machine: a linear congruential generator.
class Noise {
 public:
  /// Uniform in (−1, 1).
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11U) / 4503599627370496.0 - 1;
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace oblique::test
