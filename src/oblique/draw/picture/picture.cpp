// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/picture.h>

#include <cmath>
#include <numbers>

#include <oblique/draw/picture/text_width.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

Extent extent_of_label(const Label& label) {
  const double width = text_width(label.text, label.size, label.bold);
  const double left = label.anchor == Anchor::start    ? 0
                      : label.anchor == Anchor::middle ? -width / 2
                                                       : -width;
  constexpr double kAscent = 0.76, kDescent = 0.22;  // of the size
  const double angle = label.turned * std::numbers::pi / 180;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  Extent extent;
  for (const double x : {left, left + width}) {
    for (const double y : {-kAscent * label.size, kDescent * label.size})
      extent.extend(Vector2d(label.at.x() + cosine * x - sine * y, label.at.y() + sine * x + cosine * y));
  }
  return extent;
}

struct ExtentOf {
  Extent operator()(const Outline& outline) const {
    Extent extent;
    for (const Segment& s : outline.segments) {
      if (s.kind == Segment::Kind::close) continue;
      extent.extend(s.to);
      if (s.kind != Segment::Kind::cubic) continue;  // the curve lies within its control points
      extent.extend(s.control1);
      extent.extend(s.control2);
    }
    return extent;
  }
  Extent operator()(const Disc& disc) const {
    const Vector2d r(disc.radius, disc.radius);
    return {disc.centre - r, disc.centre + r};
  }
  Extent operator()(const Box& box) const { return {box.corner, Vector2d(box.corner + box.size)}; }
  Extent operator()(const Label& label) const { return extent_of_label(label); }
};

}  // namespace

Mark line_mark(const Vector2d& from, const Vector2d& to, const Pen& pen) {
  return polyline_mark({from, to}, pen);
}

Mark polyline_mark(const std::vector<Vector2d>& points, const Pen& pen, bool closed) {
  Outline outline;
  for (const Vector2d& point : points) {
    Segment segment;
    segment.kind = outline.segments.empty() ? Segment::Kind::move : Segment::Kind::line;
    segment.to = point;
    outline.segments.push_back(segment);
  }
  if (closed) outline.segments.push_back({Segment::Kind::close});
  return {std::move(outline), pen};
}

Mark disc_mark(const Vector2d& centre, double radius, Ink fill, const Pen& pen) {
  return {Disc{centre, radius}, pen, fill};
}

Mark box_mark(const Vector2d& corner, const Vector2d& size, Ink fill, const Pen& pen) {
  return {Box{corner, size}, pen, fill};
}

Mark label_mark(const Vector2d& at, std::string text, Anchor anchor, double size) {
  return {Label{at, std::move(text), anchor, size}, {Ink::none, 0}, Ink::line};
}

Extent extent_of(const Mark& mark) {
  Extent extent = std::visit(ExtentOf{}, mark.shape);
  if (mark.pen.ink == Ink::none || extent.isEmpty()) return extent;
  const Vector2d half(mark.pen.width / 2, mark.pen.width / 2);
  return {extent.min() - half, extent.max() + half};
}

}  // namespace oblique::draw
