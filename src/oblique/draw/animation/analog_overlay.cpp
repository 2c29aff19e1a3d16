// SPDX-License-Identifier: MIT
#include <oblique/draw/animation/analog_overlay.h>

#include <algorithm>
#include <cmath>

#include <oblique/draw/linkage/linkage_parts.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr double kWidth = 2, kRadius = 3;  // [px]

/// The points of a link in the order of their directions from the middle, so that a line through all of them
/// does not cross itself.
std::vector<std::size_t> around(const mechanism::Body& body) {
  Vector2d middle = Vector2d::Zero();
  for (const mechanism::BodyPoint& point : body.points)
    middle += point.local / static_cast<double>(body.points.size());
  std::vector<mechanism::BodyPoint> points = body.points;
  const auto direction = [&](const mechanism::BodyPoint& point) {
    const Vector2d way = point.local - middle;
    return std::atan2(way.y(), way.x());
  };
  std::stable_sort(points.begin(), points.end(),
                   [&](const mechanism::BodyPoint& a, const mechanism::BodyPoint& b) {
                     return direction(a) < direction(b);
                   });
  std::vector<std::size_t> order;
  order.reserve(points.size());
  for (const mechanism::BodyPoint& point : points) order.push_back(point.point);
  return order;
}

}  // namespace

std::vector<AnalogShape> analog_shapes(const mechanism::Mechanism& mechanism) {
  std::vector<AnalogShape> shapes;
  for (const mechanism::Body& body : mechanism.bodies) {
    if (body.points.size() > 1)
      shapes.push_back({around(body), body.points.size() > 2, "analog-body-" + body.name});
  }
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (!mechanism.points[p].fixed && is_drawn(mechanism, p))
      shapes.push_back({{p}, false, "analog-pin-" + mechanism.points[p].name});
  }
  return shapes;
}

Mark analog_mark(const AnalogShape& shape, const Axes& axes, const std::vector<Vector2d>& places) {
  std::vector<Vector2d> corners;
  for (const std::size_t p : shape.points) corners.push_back(axes.at(places[p]));
  Mark mark = corners.size() > 1 ? polyline_mark(corners, {kAnalogInk, kWidth}, shape.closed)
                                 : disc_mark(corners.front(), kRadius, kAnalogInk, {Ink::none, 0});
  mark.id = shape.id;
  return mark;
}

}  // namespace oblique::draw
