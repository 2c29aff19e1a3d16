// SPDX-License-Identifier: MIT
#include <oblique/mechanism/analysis/transmission.h>
#include <oblique/mechanism/structure/structure.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

constexpr double kPoorAngle = std::numbers::pi / 6;

/// A direction that turns with a link: `to` seen from `from`, or the line of a condition.
struct Needle {
  std::size_t from = 0, to = 0;
  std::size_t body = 0;
  const LineRef* line = nullptr;  ///< instead of the two points

  Vector2d direction(const Configuration& here) const {
    if (line == nullptr) return here.points[to].position - here.points[from].position;
    if (line->kind == LineRef::Kind::fixed) return line->direction;
    const BodyState& b = here.bodies[line->body];
    const Vector2d& u = line->direction;
    return {b.cosine * u.x() - b.sine * u.y(), b.sine * u.x() + b.cosine * u.y()};
  }
  double omega(const Configuration& here) const {
    if (line == nullptr) return here.bodies[body].omega;
    return line->kind == LineRef::Kind::fixed ? 0 : here.bodies[line->body].omega;
  }
};

struct Needles {
  Needle first, second;
};

/// The bar of an RRP dyad and its guide.
Needles bar_and_guide(const Group& group) {
  const auto& conditions = group.equations.conditions;
  const Condition& guide = conditions[group.form.loci.back()];
  Needle line;
  line.line = &guide.line;
  if (group.form.revolute) {
    const Condition& revolute = conditions[*group.form.revolute];
    return {{revolute.b.point, guide.a.point, group.equations.platforms[revolute.a.member], nullptr}, line};
  }
  const Condition& bar = conditions[group.form.loci.front()];
  return {{bar.b.point, bar.a.point, group.equations.binary_links[bar.link].body, nullptr}, line};
}

std::optional<Needles> needles_of(const Group& group) {
  if (const auto& dyad = group.form.dyad) {
    return Needles{{dyad->c, dyad->p, dyad->body1, nullptr}, {dyad->c, dyad->q, dyad->body2, nullptr}};
  }
  if (group.form.kind == GroupKind::rrp) return bar_and_guide(group);
  return std::nullopt;
}

/// The angle between two directions, in [0, π] or, for a guide, in [0, π/2], and its rate.
SignalValue angle_between(const Needles& needles, bool guide, const Configuration& here) {
  const Vector2d a = needles.first.direction(here), b = needles.second.direction(here);
  const double cross = a.x() * b.y() - a.y() * b.x(), dot = a.dot(b);
  const double rate = needles.second.omega(here) - needles.first.omega(here);
  if (!guide) return {std::atan2(std::abs(cross), dot), cross < 0 ? -rate : rate};
  return {std::atan2(std::abs(cross), std::abs(dot)), cross * dot < 0 ? -rate : rate};
}

}  // namespace

bool Transmission::is_poor() const {
  switch (measure) {
    case Measure::transmission_angle:
      return least.value < kPoorAngle || greatest.value > std::numbers::pi - kPoorAngle;
    case Measure::pressure_angle:
      return greatest.value > std::numbers::pi / 2 - kPoorAngle;
    case Measure::determinant:
      break;
  }
  return false;
}

std::string_view measure_name(Transmission::Measure measure) {
  constexpr std::array<std::string_view, 3> kNames{"transmission angle", "pressure angle", "determinant"};
  return kNames[static_cast<std::size_t>(measure)];
}

std::optional<Transmission::Measure> measure_of(const Group& group) {
  if (group.assur_class == 1) return std::nullopt;
  if (!needles_of(group)) return Transmission::Measure::determinant;
  return group.form.kind == GroupKind::rrp ? Transmission::Measure::pressure_angle
                                           : Transmission::Measure::transmission_angle;
}

Signal transmission_signal(const Structure& structure, std::size_t g) {
  const Group& group = structure.groups[g];
  if (const auto needles = needles_of(group)) {
    const bool guide = group.form.kind == GroupKind::rrp;
    return {[needles = *needles, guide](const RangeWalk& walk) {
              return angle_between(needles, guide, walk.here());
            },
            1, true};
  }
  return {[g](const RangeWalk& walk) {
            return SignalValue{std::abs(walk.normalised_determinant(g)), 0};
          },
          1, false};
}

std::optional<double> transmission_in(const Group& group, const Configuration& here) {
  const auto needles = needles_of(group);
  if (!needles || here.status == Status::open) return std::nullopt;
  return angle_between(*needles, group.form.kind == GroupKind::rrp, here).value;
}

}  // namespace oblique::mechanism
