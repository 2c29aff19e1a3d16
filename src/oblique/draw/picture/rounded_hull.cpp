// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/rounded_hull.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// One chain of the hull of sorted points (A. M. Andrew 1979), its last point left out.
template <class Iterator>
void add_chain(Iterator begin, Iterator end, std::vector<Vector2d>& hull) {
  const std::size_t first = hull.size();
  for (Iterator p = begin; p != end; ++p) {
    while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 1e-9)
      hull.pop_back();
    hull.push_back(*p);
  }
  hull.pop_back();
}

/// Corners in the order in which x turns towards y.
std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return points;
  std::vector<Vector2d> hull;
  add_chain(points.begin(), points.end(), hull);
  add_chain(points.rbegin(), points.rend(), hull);
  return hull;
}

/// An arc about `centre` from one angle to a greater one, in pieces of at most 90°.
void add_arc(Outline& outline, const Vector2d& centre, double radius, double from, double to) {
  const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / (std::numbers::pi / 2) - 1e-9)));
  const double step = (to - from) / pieces;
  const double reach = 4.0 / 3 * std::tan(step / 4) * radius;  // of the control points of a cubic
  for (int k = 0; k < pieces; ++k) {
    const double a = from + k * step, b = a + step;
    const Vector2d start(std::cos(a), std::sin(a)), stop(std::cos(b), std::sin(b));
    Segment segment{Segment::Kind::cubic, centre + radius * stop};
    segment.control1 = centre + radius * start + reach * Vector2d(-start.y(), start.x());
    segment.control2 = centre + radius * stop - reach * Vector2d(-stop.y(), stop.x());
    outline.segments.push_back(segment);
  }
}

}  // namespace

Outline rounded_hull(std::vector<Vector2d> points, double radius) {
  const std::vector<Vector2d> hull = convex_hull(std::move(points));
  Outline outline;
  constexpr double kTurn = 2 * std::numbers::pi;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vector2d before = hull[k] - hull[(k + hull.size() - 1) % hull.size()];
    const Vector2d after = hull[(k + 1) % hull.size()] - hull[k];
    const double from = hull.size() == 1 ? 0 : std::atan2(-before.x(), before.y());  // the outer normals
    double to = hull.size() == 1 ? kTurn : std::atan2(-after.x(), after.y());
    if (to < from) to += kTurn;
    const Vector2d start = hull[k] + radius * Vector2d(std::cos(from), std::sin(from));
    outline.segments.push_back({k == 0 ? Segment::Kind::move : Segment::Kind::line, start});
    add_arc(outline, hull[k], radius, from, to);
  }
  outline.segments.push_back({Segment::Kind::close});
  return outline;
}

}  // namespace oblique::draw
