// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <oblique/draw/picture/picture.h>

namespace oblique::test {

/// The mark with this id, or nothing.
const draw::Mark* find_mark(const draw::Picture& picture, const std::string& id);

/// Whether the line of a mark passes through a rectangle [px].
bool line_meets(const draw::Mark& mark, const Eigen::AlignedBox<double, 2>& box);

/// Reads a plot as a person does: by the numbers at its axes.
class Reading {
 public:
  /// The marks of one plot, or those of several of which `place` [px] has the one.
  explicit Reading(const std::vector<draw::Mark>& marks);
  Reading(const std::vector<draw::Mark>& marks, const Eigen::AlignedBox<double, 2>& place);

  /// Where a value lies [px].
  Eigen::Vector2d pixel(const Eigen::Vector2d& value) const;

 private:
  struct Scale {
    double first = 0, first_pixel = 0, last = 0, last_pixel = 0;
    bool any = false;
    void add(double value, double pixel);
    double pixel(double value) const;
  };
  Scale x_, y_;
};

}  // namespace oblique::test
