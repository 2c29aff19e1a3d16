// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/mechanism.h>

#include <algorithm>

namespace oblique::mechanism {
namespace {

template <class Items, class Predicate>
std::optional<std::size_t> index_of(const Items& items, Predicate predicate) {
  const auto found = std::find_if(items.begin(), items.end(), predicate);
  if (found == items.end()) return std::nullopt;
  return static_cast<std::size_t>(found - items.begin());
}

}  // namespace

std::optional<AtLimit> parse_at_limit(std::string_view text) {
  if (text == "open") return AtLimit::open;
  if (text == "stop") return AtLimit::stop;
  if (text == "reverse") return AtLimit::reverse;
  return std::nullopt;
}

const BodyPoint* Body::find(std::size_t point) const {
  const auto found =
      std::find_if(points.begin(), points.end(), [&](const BodyPoint& p) { return p.point == point; });
  return found == points.end() ? nullptr : &*found;
}

std::optional<std::size_t> Mechanism::find_point(std::string_view name) const {
  return index_of(points, [&](const Point& p) { return p.name == name; });
}

std::optional<std::size_t> Mechanism::find_body(std::string_view name) const {
  return index_of(bodies, [&](const Body& b) { return b.name == name; });
}

std::optional<std::size_t> Mechanism::find_slide(std::string_view name) const {
  return index_of(slides, [&](const Slide& s) { return s.name == name; });
}

std::optional<std::size_t> Mechanism::drive_of(std::size_t body) const {
  return index_of(drives, [&](const Drive& d) { return !d.slide && d.body == body; });
}

std::vector<std::size_t> Mechanism::bodies_at(std::size_t point) const {
  std::vector<std::size_t> carriers;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].find(point) != nullptr) carriers.push_back(i);
  }
  return carriers;
}

double Mechanism::largest_length() const {
  double largest = 0;
  for (const Body& body : bodies) {
    for (const BodyPoint& a : body.points) {
      for (const BodyPoint& b : body.points) largest = std::max(largest, (a.local - b.local).norm());
    }
  }
  return largest;
}

double distance(const Body& body, std::size_t first, std::size_t second) {
  const Eigen::Vector2d difference = body.find(second)->local - body.find(first)->local;
  return std::hypot(difference.x(), difference.y());
}

}  // namespace oblique::mechanism
