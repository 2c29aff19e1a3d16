// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/free_turn.h>

#include <algorithm>

#include <oblique/mechanism/triad/triangle.h>

namespace oblique::mechanism {

std::optional<std::size_t> free_to_turn_about(const GroupEquations& equations, const Configuration& here) {
  using Kind = Condition::Kind;
  std::optional<std::size_t> place;
  const auto is_elsewhere = [&](const PointRef& point) {
    if (point.kind != PointRef::Kind::known) return false;
    if (!place) place = point.point;
    const Eigen::Vector2d& at = here.points[*place].position;
    const Eigen::Vector2d& other = here.points[point.point].position;
    const double size = std::max(at.lpNorm<Eigen::Infinity>(), other.lpNorm<Eigen::Infinity>());
    return !((other - at).norm() <= flat_within(size));
  };
  for (const Condition& c : equations.conditions) {
    switch (c.kind) {
      case Kind::distance:
      case Kind::coincidence:
        if (is_elsewhere(c.a) || is_elsewhere(c.b)) return std::nullopt;
        break;
      case Kind::on_line:
      case Kind::along:
        if (c.line.kind != LineRef::Kind::carried || is_elsewhere(c.a)) return std::nullopt;
        break;
      case Kind::orientation:
        if (c.drive || c.line.kind != LineRef::Kind::carried) return std::nullopt;
        break;
    }
  }
  return place;
}

}  // namespace oblique::mechanism
