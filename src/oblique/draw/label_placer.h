// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <oblique/draw/picture.h>

namespace oblique {

/// Finds places for names beside points: of eight places around, and farther ones where all eight are taken,
/// the one that covers least.
class LabelPlacer {
 public:
  /// Labels stay within `frame` [px] if they can.
  explicit LabelPlacer(const Eigen::AlignedBox<double, 2>& frame) : frame_(frame) {}

  /// Keeps labels off the lines of a mark, and off its inside where it is filled: the more the greater
  /// `weight`.
  void avoid(const Mark& mark, double weight);

  /// The weights of all that a label at `place` [px] would touch, and far more where it leaves the frame.
  double cost(const Eigen::AlignedBox<double, 2>& place) const;

  /// A label for the point `at` [px], which later ones then avoid.
  Mark place(const Eigen::Vector2d& at, const std::string& text, double size);

 private:
  struct Obstacle {
    std::vector<Eigen::Vector2d> line;  ///< its points in order
    double half_width = 0;
    bool filled = false;
    double weight = 1;
    Eigen::AlignedBox<double, 2> extent;
  };

  Eigen::AlignedBox<double, 2> frame_;
  std::vector<Obstacle> obstacles_;
};

}  // namespace oblique
