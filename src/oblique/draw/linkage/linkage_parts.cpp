// SPDX-License-Identifier: MIT
#include <oblique/draw/linkage/linkage_parts.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <oblique/draw/linkage/slider_blocks.h>
#include <oblique/draw/picture/rounded_hull.h>
#include <oblique/mechanism/model/plane.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Carrier = LinkagePart::Carrier;

constexpr double kLinkRadius = 6, kPinRadius = 4.5, kMarkRadius = 3;  // [px]
constexpr double kOverhang = 26;  // of a guide beyond the way of its block [px]

Pen thin_pen() {
  return {Ink::line, kThinLine};
}

/// From what the distance of a prismatic joint's point from its line's first point is measured.
Vector2d line_direction(const mechanism::Mechanism& mechanism, const mechanism::Slide& slide) {
  if (!slide.carrier) {
    return (mechanism.points[slide.second].position - mechanism.points[slide.first].position).normalized();
  }
  const mechanism::Body& carrier = mechanism.bodies[*slide.carrier];
  return (carrier.find(slide.second)->local - carrier.find(slide.first)->local).normalized();
}

double angle_of(const Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

struct Range {
  double least = 0, greatest = 0;
};

/// Where a prismatic joint's point goes along its line [length unit].
Range range_of(const std::vector<mechanism::Configuration>& motion, std::size_t slide) {
  bool any = false;
  Range range;
  for (const mechanism::Configuration& here : motion) {
    const double position = here.slides[slide].position;
    if (!std::isfinite(position)) continue;
    range.least = any ? std::min(range.least, position) : position;
    range.greatest = any ? std::max(range.greatest, position) : position;
    any = true;
  }
  return range;
}

bool slides_along(const mechanism::Mechanism& mechanism, std::size_t point) {
  return std::any_of(mechanism.slides.begin(), mechanism.slides.end(),
                     [&](const mechanism::Slide& slide) { return slide.point == point; });
}

/// Whether a link covers more than the line through its first two points.
bool is_plate(const mechanism::Body& body) {
  constexpr double kRounding = 1e-9;
  return std::any_of(body.points.begin(), body.points.end(), [](const mechanism::BodyPoint& point) {
    return std::abs(point.local.y()) > kRounding * point.local.norm();
  });
}

Layer layer_of(const LinkagePart& part) {
  if (part.carrier == Carrier::point) return Layer::pins;
  return part.carrier == Carrier::slide || part.carrier == Carrier::drive ? Layer::blocks : Layer::bodies;
}

/// The sign of the frame: a line with strokes on its lower side.
void add_ground(std::vector<Mark>& marks, double from, double to, double y, const std::string& id) {
  constexpr double kPitch = 6, kDepth = 6;
  marks.push_back(line_mark({from, y}, {to, y}, {Ink::line, 1.5}));
  Outline strokes;
  const int n = static_cast<int>((to - from) / kPitch + 1e-9);
  for (int k = 1; k <= n; ++k) {
    const double x = from + k * kPitch;
    strokes.segments.push_back({Segment::Kind::move, {x, y}});
    strokes.segments.push_back({Segment::Kind::line, {x - kDepth, y + kDepth}});
  }
  marks.push_back({strokes, {Ink::line, 1}});
  marks.back().id = id;
}

LinkagePart support(const mechanism::Mechanism& mechanism, std::size_t point) {
  constexpr double kHalf = 10, kHeight = 18, kBase = 15;
  LinkagePart part{Carrier::frame, point};
  part.marks.push_back(polyline_mark({{0, 0}, {-kHalf, kHeight}, {kHalf, kHeight}}, thin_pen(), true));
  part.marks.back().fill = Ink::paper;
  add_ground(part.marks, -kBase, kBase, kHeight, "ground-" + mechanism.points[point].name);
  return part;
}

/// The guide of a slide in the frame: its centre line, and the ground under the block.
LinkagePart frame_guide(const mechanism::Mechanism& mechanism,
                        const std::vector<mechanism::Configuration>& motion, std::size_t index,
                        double scale) {
  const Range range = range_of(motion, index);
  const double from = range.least * scale - kOverhang, to = range.greatest * scale + kOverhang;
  const double y = -mechanism.slides[index].offset * scale;
  LinkagePart part{Carrier::guide, index};
  part.marks.push_back(line_mark({from, y}, {to, y}, {Ink::line, 1, {8, 3, 2, 3}}));
  add_ground(part.marks, from, to, y + kSliderHeight / 2 + 1, "guide-" + mechanism.slides[index].name);
  return part;
}

/// The line of a prismatic joint on a link, where it goes beyond the link itself.
void add_body_guide(LinkagePart& part, const mechanism::Mechanism& mechanism,
                    const std::vector<mechanism::Configuration>& motion, std::size_t index, double scale) {
  const mechanism::Slide& slide = mechanism.slides[index];
  const mechanism::Body& body = mechanism.bodies[*slide.carrier];
  const Vector2d first = body.find(slide.first)->local, second = body.find(slide.second)->local;
  const double length = (second - first).norm();
  const Range range = range_of(motion, index);
  if (slide.offset == 0 && range.least >= 0 && range.greatest <= length) return;
  const Vector2d along = (second - first) / length, left = mechanism::left_normal(along);
  const auto pixel = [&](double position) -> Vector2d {
    const Vector2d local = first + position * along + slide.offset * left;
    return {local.x() * scale, -local.y() * scale};
  };
  const double overhang = kOverhang / scale;
  part.marks.push_back(line_mark(pixel(std::min(0.0, range.least - overhang)),
                                 pixel(std::max(length, range.greatest + overhang)), {Ink::line, 2.5}));
}

Outline outline_of(const mechanism::Body& body, double scale) {
  std::vector<Vector2d> points;
  for (const mechanism::BodyPoint& point : body.points)
    points.emplace_back(point.local.x() * scale, -point.local.y() * scale);
  return rounded_hull(std::move(points), kLinkRadius);
}

Mark inside_of(const mechanism::Mechanism& mechanism, std::size_t index, double scale) {
  Mark inside{outline_of(mechanism.bodies[index], scale),
              {Ink::none, 0},
              mechanism.drive_of(index) ? Ink::orange : Ink::faint};
  inside.opacity = kInsideOpacity;
  inside.id = "inside-" + mechanism.bodies[index].name;
  return inside;
}

/// A bar; of a plate what lies over its inside.
LinkagePart body_part(const mechanism::Mechanism& mechanism,
                      const std::vector<mechanism::Configuration>& motion, std::size_t index, double scale) {
  const mechanism::Body& body = mechanism.bodies[index];
  LinkagePart part{Carrier::body, index};
  for (std::size_t s = 0; s < mechanism.slides.size(); ++s) {
    if (mechanism.slides[s].carrier == index) add_body_guide(part, mechanism, motion, s, scale);
  }
  if (!is_plate(body)) part.marks.push_back(inside_of(mechanism, index, scale));
  Mark edge{outline_of(body, scale), thin_pen()};
  edge.id = "body-" + body.name;
  part.marks.push_back(edge);
  return part;
}

LinkagePart pin_part(const mechanism::Mechanism& mechanism, std::size_t index) {
  const mechanism::Point& point = mechanism.points[index];
  const bool joint = point.fixed || mechanism.bodies_at(index).size() > 1 || slides_along(mechanism, index);
  LinkagePart part{Carrier::point, index};
  part.marks.push_back(joint ? disc_mark({0, 0}, kPinRadius, Ink::paper, {Ink::line, 1.8})
                             : disc_mark({0, 0}, kMarkRadius, Ink::line, {Ink::none, 0}));
  part.marks.back().id = "pin-" + point.name;
  return part;
}

}  // namespace

bool is_drawn(const mechanism::Mechanism& mechanism, std::size_t point) {
  return !mechanism.bodies_at(point).empty() || slides_along(mechanism, point);
}

std::span<const LinkagePart> parts_in(Layer layer, const std::vector<LinkagePart>& parts) {
  const auto begin = std::partition_point(parts.begin(), parts.end(),
                                          [&](const LinkagePart& part) { return layer_of(part) < layer; });
  const auto end = std::partition_point(begin, parts.end(),
                                        [&](const LinkagePart& part) { return layer_of(part) == layer; });
  return std::span(parts).subspan(static_cast<std::size_t>(begin - parts.begin()),
                                  static_cast<std::size_t>(end - begin));
}

PartPose pose_of(const LinkagePart& part, const mechanism::Mechanism& mechanism,
                 const mechanism::Configuration& here) {
  switch (part.carrier) {
    case Carrier::frame:
    case Carrier::point:
      return {here.points[part.index].position};
    case Carrier::body:
      return {here.points[mechanism.bodies[part.index].points.front().point].position,
              here.bodies[part.index].angle};
    case Carrier::guide: {
      const mechanism::Slide& slide = mechanism.slides[part.index];
      return {mechanism.points[slide.first].position, angle_of(line_direction(mechanism, slide))};
    }
    case Carrier::slide:
    case Carrier::drive:
      break;
  }
  const mechanism::Slide& slide = mechanism.slides[part.index];
  const double turned_by = slide.carrier ? here.bodies[*slide.carrier].angle : 0;
  const bool back = part.carrier == Carrier::drive && goes_back(mechanism, part.index, here);
  return {here.points[slide.point].position,
          turned_by + angle_of(line_direction(mechanism, slide)) + (back ? std::numbers::pi : 0)};
}

Mark placed(const Mark& mark, const Vector2d& at, double angle) {
  Mark moved = mark;
  const auto move = [&](Vector2d& p) { p = at + mechanism::turned(p, -angle); };  // y goes down
  if (auto* const outline = std::get_if<Outline>(&moved.shape)) {
    for (Segment& segment : outline->segments) {
      move(segment.to);
      move(segment.control1);
      move(segment.control2);
    }
  } else if (auto* const disc = std::get_if<Disc>(&moved.shape)) {
    move(disc->centre);
  } else if (auto* const box = std::get_if<Box>(&moved.shape)) {
    box->corner += at;
  } else {
    std::get<Label>(moved.shape).at += at;
  }
  return moved;
}

std::vector<LinkagePart> linkage_parts(const mechanism::Mechanism& mechanism,
                                       const std::vector<mechanism::Configuration>& motion, double scale) {
  std::vector<LinkagePart> parts;
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    if (is_plate(mechanism.bodies[b])) parts.push_back({Carrier::body, b, {inside_of(mechanism, b, scale)}});
  }
  for (std::size_t s = 0; s < mechanism.slides.size(); ++s) {
    if (!mechanism.slides[s].carrier) parts.push_back(frame_guide(mechanism, motion, s, scale));
  }
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (mechanism.points[p].fixed && is_drawn(mechanism, p)) parts.push_back(support(mechanism, p));
  }
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b)
    parts.push_back(body_part(mechanism, motion, b, scale));
  for (LinkagePart& part : slider_blocks(mechanism)) parts.push_back(std::move(part));
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (is_drawn(mechanism, p)) parts.push_back(pin_part(mechanism, p));
  }
  return parts;
}

}  // namespace oblique::draw
