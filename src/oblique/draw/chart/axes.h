// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <oblique/draw/picture/picture.h>
#include <oblique/draw/picture/scale.h>

namespace oblique::draw {

/// A rectangle of paper with a scale along its lower and left edge.
///
/// ```
///   y [mm]
///   ┌────────┐
///   │        │  frame(): what is drawn lies in it
///   └────────┘
///     x [mm]
/// ```
class Axes {
 public:
  enum class Shape {
    stretched,  ///< each axis fills its side
    equal,      ///< a unit is as long in x as in y: what is shown grows on one axis to fill the place
  };
  static constexpr double kNumberSize = 11, kTitleSize = 12;  ///< of the texts [px]
  static constexpr double kHead = 10;    ///< least way from the frame up to the title of y [px]
  static constexpr double kFoot = 36;    ///< what numbers and title of x take below the frame [px]
  static constexpr double kTickGap = 6;  ///< between the frame and the numbers [px]

  /// With this frame [px].
  Axes(const Eigen::AlignedBox<double, 2>& frame, Scale x, Scale y, Shape shape);
  /// With numbers and titles within `place` [px].
  static Axes within(const Eigen::AlignedBox<double, 2>& place, const Scale& x, const Scale& y, Shape shape);

  /// Where a point of the data lies [px].
  Eigen::Vector2d at(const Eigen::Vector2d& data) const;
  /// Whether it lies anywhere: it has values, and logarithms on logarithmic axes.
  bool shows(const Eigen::Vector2d& data) const;
  /// How long a unit is on linear axes [px].
  Eigen::Vector2d scale() const;
  /// The rectangle within the axes [px].
  const Eigen::AlignedBox<double, 2>& frame() const { return frame_; }

  /// The width of the numbers of y [px].
  double number_width() const;
  std::string y_title() const { return y_.title(); }

  /// Grid, numbers, frame and titles, to be drawn before the data; the title of y so far above the frame
  /// [px].
  std::vector<Mark> marks(double head = kHead) const;
  /// The same without numbers and title of x, for axes that have the x of those under them.
  std::vector<Mark> marks_without_x(double head = kHead) const;

 private:
  std::vector<Tick> x_ticks() const;
  std::vector<Tick> y_ticks() const;
  std::vector<Mark> grid() const;

  Eigen::AlignedBox<double, 2> frame_;
  Scale x_, y_;
  Shape shape_;
};

/// A curve through points of the data, with a gap where a coordinate is not a number.
Mark curve_mark(const Axes& axes, const std::vector<Eigen::Vector2d>& data, const Pen& pen);

}  // namespace oblique::draw
