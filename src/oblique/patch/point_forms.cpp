// SPDX-License-Identifier: MIT
#include <oblique/patch/point_forms.h>

namespace oblique::patch {

void PointForms::set_scale(const Scaling& scaling) {
  origin_ = scaling.origin;
  unit_ = scaling.length;
  for (std::size_t point = 0; point < points_.size(); ++point) {
    const mechanism::Point& p = mechanism_.points[point];
    if (!p.fixed) continue;
    VectorForm form;
    form.x.constant = scaled(p.position.x() - origin_.x());
    form.y.constant = scaled(p.position.y() - origin_.y());
    points_[point] = form;
  }
}

void PointForms::set_signals(std::size_t point, const std::string& x, const std::string& y) {
  points_[point] = VectorForm{weighted(x), weighted(y)};
}

const std::pair<mechanism::BodyPoint, mechanism::BodyPoint>& PointForms::base_of(std::size_t body) {
  const auto& points = mechanism_.bodies[body].points;
  return bases_.try_emplace(body, points[0], points[1]).first->second;
}

VectorForm PointForms::direction_of(std::size_t body, const Eigen::Vector2d& local) {
  const auto& [p, c] = base_of(body);
  const Eigen::Vector2d base = c.local - p.local;
  const double squared = base.squaredNorm() / unit_;
  const double a = base.dot(local) / squared, b = (base.x() * local.y() - base.y() * local.x()) / squared;
  const VectorForm& from = *points_[p.point];
  const VectorForm& to = *points_[c.point];
  return {combined({{a, &to.x}, {-a, &from.x}, {-b, &to.y}, {b, &from.y}}),
          combined({{a, &to.y}, {-a, &from.y}, {b, &to.x}, {-b, &from.x}})};
}

VectorForm PointForms::point_of(std::size_t body, const Eigen::Vector2d& local) {
  const auto& [p, c] = base_of(body);
  VectorForm way = direction_of(body, (local - p.local) / unit_);
  way.x.add(points_[p.point]->x);
  way.y.add(points_[p.point]->y);
  return way;
}

PointForms::LineForm PointForms::line_form(const std::optional<std::size_t>& carrier,
                                           const mechanism::LineRef& line) {
  if (carrier) return {point_of(*carrier, line.point), direction_of(*carrier, line.direction)};
  LineForm form;
  form.at.x.constant = scaled(line.point.x() - origin_.x());
  form.at.y.constant = scaled(line.point.y() - origin_.y());
  form.direction.x.constant = line.direction.x();
  form.direction.y.constant = line.direction.y();
  return form;
}

}  // namespace oblique::patch
