// SPDX-License-Identifier: MIT
#include <oblique/patch/point_book.h>

namespace oblique::patch {

PointBook::PointBook(const mechanism::Mechanism& mechanism, const Scaling& scaling)
    : mechanism_(mechanism),
      origin_(scaling.origin),
      unit_(scaling.length),
      forms_(mechanism.points.size()),
      signals_(mechanism.points.size()) {
  for (std::size_t point = 0; point < forms_.size(); ++point) {
    const mechanism::Point& p = mechanism_.points[point];
    if (!p.fixed) continue;
    forms_[point] = VectorForm{constant(scaled(p.position.x() - origin_.x())),
                               constant(scaled(p.position.y() - origin_.y()))};
  }
}

void PointBook::set_signals(std::size_t point, PointSignals signals) {
  forms_[point] = VectorForm{weighted(signals.x), weighted(signals.y)};
  signals_[point] = std::move(signals);
}

void PointBook::set_base(std::size_t body, std::size_t p, std::size_t c) {
  bases_[body] = {*mechanism_.bodies[body].find(p), *mechanism_.bodies[body].find(c)};
}

PointBook::Base PointBook::base_of(std::size_t body) const {
  const auto known = bases_.find(body);
  if (known != bases_.end()) return known->second;
  const auto& points = mechanism_.bodies[body].points;
  return {points[0], points[1]};
}

void PointBook::carry(std::size_t body) {
  for (const mechanism::BodyPoint& p : mechanism_.bodies[body].points) {
    if (!has(p.point)) set(p.point, point_of(body, p.local));
  }
}

VectorForm PointBook::direction_of(std::size_t body, const Eigen::Vector2d& local) const {
  const auto [p, c] = base_of(body);
  const Eigen::Vector2d base = c.local - p.local;
  const double squared = base.squaredNorm() / unit_;
  const double a = base.dot(local) / squared, b = (base.x() * local.y() - base.y() * local.x()) / squared;
  const VectorForm& from = at(p.point);
  const VectorForm& to = at(c.point);
  return {combined({{a, &to.x}, {-a, &from.x}, {-b, &to.y}, {b, &from.y}}),
          combined({{a, &to.y}, {-a, &from.y}, {b, &to.x}, {-b, &from.x}})};
}

VectorForm PointBook::point_of(std::size_t body, const Eigen::Vector2d& local) const {
  const auto [p, c] = base_of(body);
  VectorForm way = direction_of(body, (local - p.local) / unit_);
  way.x.add(at(p.point).x);
  way.y.add(at(p.point).y);
  return way;
}

PointBook::LineForm PointBook::line_form(const std::optional<std::size_t>& carrier,
                                         const mechanism::LineRef& line) const {
  if (carrier) return {point_of(*carrier, line.point), direction_of(*carrier, line.direction)};
  return {{constant(scaled(line.point.x() - origin_.x())), constant(scaled(line.point.y() - origin_.y()))},
          {constant(line.direction.x()), constant(line.direction.y())}};
}

}  // namespace oblique::patch
