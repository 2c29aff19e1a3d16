// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <oblique/draw/picture.h>

namespace oblique {

/// The greatest of 1, 2 and 5 times a power of ten that divides `span` into at least about `wanted` parts.
double round_step(double span, int wanted);

/// The multiples of `step` from `least` to `greatest`.
std::vector<double> ticks_between(double least, double greatest, double step);

/// "0.25": with as many digits as a scale of this step needs, and a true minus sign.
std::string tick_text(double value, double step);

/// One direction of a plot, in its own unit.
struct Axis {
  std::string label;               ///< "x [mm]"
  double least = 0, greatest = 1;  ///< what has to be seen
  double step = 0;                 ///< between ticks; 0: a round number is chosen
};

/// A rectangle of paper with a scale along its lower and left edge.
///
/// ```
///   title
///  y ┌────────┐  frame(): what is drawn lies in it
///    └────────┘
///         x
/// ```
class Axes {
 public:
  enum class Shape {
    stretched,  ///< each axis fills its side
    equal,      ///< a unit is as long in x as in y: what is shown grows on one axis to fill the place
  };

  /// `place` [px]: where everything goes, the numbers and labels too.
  Axes(const Eigen::AlignedBox<double, 2>& place, Axis x, Axis y, Shape shape, std::string title = {});

  /// Where a point of the data lies [px].
  Eigen::Vector2d at(const Eigen::Vector2d& data) const;
  /// How long a unit is [px].
  Eigen::Vector2d scale() const { return scale_; }
  /// The rectangle within the axes [px].
  const Eigen::AlignedBox<double, 2>& frame() const { return frame_; }

  /// Grid, frame, numbers, labels and title: to be drawn before the data.
  std::vector<Mark> marks() const;

 private:
  Eigen::AlignedBox<double, 2> frame_;
  Axis x_, y_;
  std::string title_;
  Eigen::Vector2d scale_ = Eigen::Vector2d::Ones();
};

/// A curve through points of the data, with a gap where a coordinate is not a number.
Mark curve_mark(const Axes& axes, const std::vector<Eigen::Vector2d>& data, const Pen& pen);

}  // namespace oblique
