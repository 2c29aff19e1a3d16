// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include <oblique/draw/picture/picture.h>

namespace oblique::draw {

/// The outline at the distance `radius` [px] around the convex hull of points: a bar with round ends about
/// two, a plate with round corners about more. At least one point.
Outline rounded_hull(std::vector<Eigen::Vector2d> points, double radius);

}  // namespace oblique::draw
