// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/label_placer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr int kPiecesOfCurve = 6;
constexpr double kOfName = 100;  // weight

std::vector<Vector2d> corners(const Extent& box) {
  return {box.min(), {box.max().x(), box.min().y()}, box.max(), {box.min().x(), box.max().y()}, box.min()};
}

/// The points of an outline with its curves taken as short lines.
std::vector<Vector2d> points_of(const Outline& outline) {
  std::vector<Vector2d> points;
  for (const Segment& s : outline.segments) {
    if (s.kind == Segment::Kind::close) {
      points.push_back(outline.segments.front().to);
    } else if (s.kind == Segment::Kind::cubic) {
      const Vector2d from = points.back();
      for (int k = 1; k <= kPiecesOfCurve; ++k) {
        const double t = static_cast<double>(k) / kPiecesOfCurve, u = 1 - t;
        points.emplace_back(u * u * u * from + 3 * u * u * t * s.control1 + 3 * u * t * t * s.control2 +
                            t * t * t * s.to);
      }
    } else {
      points.push_back(s.to);
    }
  }
  return points;
}

/// Whether a line from a to b passes through a box (Liang, Barsky 1984).
bool crosses(const Extent& box, const Vector2d& a, const Vector2d& b) {
  double enter = 0, leave = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double way = b[axis] - a[axis];
    if (way == 0) {
      if (a[axis] < box.min()[axis] || a[axis] > box.max()[axis]) return false;
      continue;
    }
    const double one = (box.min()[axis] - a[axis]) / way, other = (box.max()[axis] - a[axis]) / way;
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter <= leave;
}

bool contains(const std::vector<Vector2d>& polygon, const Vector2d& p) {
  bool inside = false;
  for (std::size_t k = 0; k + 1 < polygon.size(); ++k) {
    const Vector2d &a = polygon[k], &b = polygon[k + 1];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

}  // namespace

std::optional<Vector2d> leader_end(const Extent& name, const Vector2d& at) {
  const Vector2d nearest = at.cwiseMax(name.min()).cwiseMin(name.max());
  if ((nearest - at).norm() <= kFarthestBeside) return std::nullopt;
  return nearest;
}

Mark leader_mark(const Vector2d& from, const Vector2d& to, const std::string& point) {
  constexpr double kWidth = 0.75;
  Mark leader = line_mark(from, to, {Ink::line, kWidth});
  leader.id = "leader-" + point;
  return leader;
}

void LabelPlacer::avoid(const Mark& mark, double weight) {
  Obstacle obstacle;
  if (const auto* const outline = std::get_if<Outline>(&mark.shape)) {
    obstacle.line = points_of(*outline);
  } else {
    obstacle.line = corners(extent_of(mark));
  }
  obstacle.filled = mark.fill != Ink::none;
  obstacle.half_width = mark.pen.ink == Ink::none ? 0 : mark.pen.width / 2;
  obstacle.weight = weight;
  obstacle.extent = extent_of(mark);
  obstacles_.push_back(std::move(obstacle));
}

double LabelPlacer::cost(const Extent& place, const Vector2d& at) const {
  constexpr double kGap = 2;        // [px] between a label and what it avoids
  constexpr double kOutside = 1e4;  // beside the weights of obstacles
  double sum = frame_.contains(place) ? 0 : kOutside;
  for (const Obstacle& o : obstacles_) {
    const Vector2d gap = Vector2d::Constant(kGap + o.half_width);
    const Extent wide(place.min() - gap, place.max() + gap);
    if (!wide.intersects(o.extent)) continue;
    bool touches = o.filled && contains(o.line, place.center());
    for (std::size_t k = 0; k + 1 < o.line.size() && !touches; ++k)
      touches = crosses(wide, o.line[k], o.line[k + 1]);
    if (touches) sum += o.weight;
  }
  const std::optional<Vector2d> end = leader_end(place, at);
  if (!end) return sum;
  constexpr double kLeaderGap = 4;  // [px] between a leader line and what it does not lead to
  const Vector2d leader_gap = Vector2d::Constant(kLeaderGap);
  const auto crossed = std::count_if(signs_.begin(), signs_.end(), [&](const Extent& sign) {
    const Extent wide(sign.min() - leader_gap, sign.max() + leader_gap);
    return !wide.contains(at) && crosses(wide, at, *end);
  });
  return sum + kOfName * static_cast<double>(crossed);
}

void LabelPlacer::add_name(const Mark& name, const Vector2d& at) {
  avoid(name, kOfName);
  signs_.push_back(extent_of(name));
  if (const auto end = leader_end(signs_.back(), at)) avoid(line_mark(at, *end), kOfName);
}

Mark LabelPlacer::place(const Vector2d& at, const std::string& text, double size) {
  constexpr std::array<double, 8> kDirections{45, 135, -45, -135, 90, 0, 180, -90};  // [°], those liked first
  constexpr std::array<double, 8> kDistances{8, 12, 17, 23, 30, 38, 48, 60};         // [px]
  Mark best = label_mark({0, 0}, text, Anchor::middle, size);
  std::get<Label>(best.shape).bold = true;
  const Extent own = extent_of(best);
  const Vector2d half = own.sizes() / 2;
  double least = std::numeric_limits<double>::infinity();
  Vector2d chosen = at;
  for (const double distance : kDistances) {
    for (const double direction : kDirections) {
      const double angle = direction * std::numbers::pi / 180;
      const Vector2d way(std::cos(angle), -std::sin(angle));
      const Vector2d sign(std::abs(way.x()) < 0.1 ? 0 : std::copysign(1, way.x()),
                          std::abs(way.y()) < 0.1 ? 0 : std::copysign(1, way.y()));
      const Vector2d centre = at + distance * way + sign.cwiseProduct(half);
      const double sum = cost({centre - half, centre + half}, at);
      if (sum >= least) continue;
      least = sum;
      chosen = centre;
    }
    if (least == 0) break;
  }
  std::get<Label>(best.shape).at = chosen - own.center();
  add_name(best, at);
  return best;
}

}  // namespace oblique::draw
