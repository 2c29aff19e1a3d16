// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <oblique/draw/chart/axes.h>
#include <oblique/draw/picture/picture.h>
#include <oblique/mechanism/model/mechanism.h>

namespace oblique::draw {

/// The colour of the analog mechanism; paths of the exact one do without it.
inline constexpr Ink kAnalogInk = Ink::vermilion;

/// A thing of the analog mechanism: a link as a line or a polygon through its points, or one point. The
/// errors change its shape, so it is told by the places of its points.
struct AnalogShape {
  std::vector<std::size_t> points;  ///< of Mechanism::points, in the order in which a line goes through them
  bool closed = false;              ///< of three points and more
  std::string id;                   ///< "analog-body-AB", "analog-pin-B"
};

/// Links, and over them the moving points.
std::vector<AnalogShape> analog_shapes(const mechanism::Mechanism& mechanism);

/// A shape in the picture, with the points of the mechanism at `places` [length unit].

Mark analog_mark(const AnalogShape& shape, const Axes& axes, const std::vector<Eigen::Vector2d>& places);

}  // namespace oblique::draw
