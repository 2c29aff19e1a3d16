// SPDX-License-Identifier: MIT
#include "reading.h"

#include <cstdlib>
#include <optional>

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr double kNumberSize = 11;  // [px]; larger texts are no numbers of an axis

std::optional<double> number_of(std::string text) {
  const std::string minus = "−";
  if (text.starts_with(minus)) text = "-" + text.substr(minus.size());
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') return std::nullopt;
  return value;
}

}  // namespace

const draw::Mark* find_mark(const draw::Picture& picture, const std::string& id) {
  for (const draw::Mark& mark : picture.marks) {
    if (mark.id == id) return &mark;
  }
  return nullptr;
}

bool line_meets(const draw::Mark& mark, const Extent& box) {
  if (const auto* const disc = std::get_if<draw::Disc>(&mark.shape))
    return box.exteriorDistance(disc->centre) < disc->radius;
  const auto* const outline = std::get_if<draw::Outline>(&mark.shape);
  if (outline == nullptr) return !box.intersection(draw::extent_of(mark)).isEmpty();
  constexpr int kSteps = 400;  // of each piece: less than 2 px apart
  Vector2d from = outline->segments.front().to;
  for (const draw::Segment& s : outline->segments) {
    const Vector2d to = s.kind == draw::Segment::Kind::close ? outline->segments.front().to : s.to;
    const bool curved = s.kind == draw::Segment::Kind::cubic;
    const Vector2d c1 = curved ? s.control1 : Vector2d(from + (to - from) / 3);
    const Vector2d c2 = curved ? s.control2 : Vector2d(to - (to - from) / 3);
    for (int k = 0; k <= kSteps && s.kind != draw::Segment::Kind::move; ++k) {
      const double t = static_cast<double>(k) / kSteps, u = 1 - t;
      if (box.contains(Vector2d(u * u * u * from + 3 * u * u * t * c1 + 3 * u * t * t * c2 + t * t * t * to)))
        return true;
    }
    from = to;
  }
  return false;
}

Reading::Reading(const std::vector<draw::Mark>& marks)
    : Reading(marks, Extent(Vector2d::Constant(-1e9), Vector2d::Constant(1e9))) {}

Reading::Reading(const std::vector<draw::Mark>& marks, const Extent& place) {
  for (const draw::Mark& mark : marks) {
    const auto* const label = std::get_if<draw::Label>(&mark.shape);
    if (label == nullptr || label->size > kNumberSize || !place.contains(label->at)) continue;
    const auto value = number_of(label->text);
    if (!value) continue;
    const Vector2d centre = draw::extent_of(mark).center();
    if (label->anchor == draw::Anchor::middle) x_.add(*value, centre.x());
    if (label->anchor == draw::Anchor::end)
      y_.add(*value, label->at.y() - 4);  // half a digit above the baseline
  }
}

void Reading::Scale::add(double value, double pixel) {
  if (!any) {
    first = value;
    first_pixel = pixel;
  }
  any = true;
  last = value;
  last_pixel = pixel;
}

double Reading::Scale::pixel(double value) const {
  return first_pixel + (value - first) * (last_pixel - first_pixel) / (last - first);
}

Vector2d Reading::pixel(const Vector2d& value) const {
  return {x_.pixel(value.x()), y_.pixel(value.y())};
}

}  // namespace oblique::test
