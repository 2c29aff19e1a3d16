// SPDX-License-Identifier: MIT
// Laws that hold for every dyad, on random ones.
#include <oblique/mechanism/model/configuration.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A number in [from, to], evenly spread.
rc::Gen<double> between(double from, double to) {
  return rc::gen::map(rc::gen::inRange(0, 1'000'001), [=](int k) { return from + (to - from) * k / 1e6; });
}

/// A crank about O and a dyad from its pin P to a second crank's pin Q: both pivots of the dyad move.
///
///       r₁  C  r₂      the dyad's triangle has an angle of `spread` at C, from 10° to 170°: a thinner one
///      P ·     · Q     multiplies roundings by more than 1/sin 10° ≈ 6
///     ·           ·
///    O             S
struct MovingDyad {
  Mechanism mechanism;
  Vector2d joint;  ///< where C was put
};

MovingDyad make_dyad(double crank_angle, double second_angle, double r1, double r2, double direction,
                     double spread, double speed, double second_speed) {
  const Vector2d p(std::cos(crank_angle), std::sin(crank_angle));
  const Vector2d c = p + r1 * Vector2d(std::cos(direction), std::sin(direction));
  const Vector2d q = c - r2 * Vector2d(std::cos(direction + spread), std::sin(direction + spread));
  const Vector2d s = q - Vector2d(std::cos(second_angle), std::sin(second_angle));
  MovingDyad dyad{{}, c};
  Mechanism& m = dyad.mechanism;
  m.points = {{"O", true, Vector2d::Zero()},
              {"S", true, s},
              {"P", false, {}},
              {"Q", false, {}},
              {"C", false, {}},
              {"M", false, {}}};
  m.bodies = {{"OP", {{0, {0, 0}}, {2, {1, 0}}}, {}},
              {"SQ", {{1, {0, 0}}, {3, {1, 0}}}, {}},
              {"CP", {{4, {0, 0}}, {2, {r1, 0}}, {5, {0.3, 0.7}}}, {}},
              {"QC", {{3, {0, 0}}, {4, {r2, 0}}}, {}}};
  m.drives = {{"first", 0, 0, speed, crank_angle, {}}, {"second", 1, 1, second_speed, second_angle, {}}};
  m.sketch = {{4, c + Vector2d(1e-3, 1e-3)}};
  return dyad;
}

RC_GTEST_PROP(RandomDyad, IsPutTogetherAsItWasTakenApart, ()) {
  const double r1 = *between(0.5, 3);
  const double r2 = *between(0.5, 3);
  const double spread =
      *between(std::numbers::pi / 18, 17 * std::numbers::pi / 18) * *rc::gen::element(-1, 1);
  const MovingDyad dyad = make_dyad(
      *between(-std::numbers::pi, std::numbers::pi), *between(-std::numbers::pi, std::numbers::pi), r1, r2,
      *between(-std::numbers::pi, std::numbers::pi), spread, *between(-3, 3), *between(-3, 3));
  const Mechanism& m = dyad.mechanism;
  const Structure structure = decompose(m);
  const Configuration here = start_configuration(m, structure);
  RC_ASSERT(here.status == Status::ok);
  const auto& [o, s, p, q, c, mark] = std::tie(here.points[0], here.points[1], here.points[2], here.points[3],
                                               here.points[4], here.points[5]);

  // coordinates up to 10 with some ten roundings each, times 1/sin 10°
  const double position_rounding = 2e-13;
  RC_ASSERT((c.position - dyad.joint).norm() < position_rounding);
  const double side = structure.groups.back().side;
  RC_ASSERT(side * cross(q.position - p.position, c.position - p.position) > 0);

  // Rigid bars: |e|² is constant, so e·ė = 0 and e·ë + ė² = 0. Rates reach 3·6·6 and their squares: 1e3 and
  // roundings of each.
  const double speed_rounding = 1e-11;
  const double acceleration_rounding = 1e-9;
  for (const auto& [from, to, length] : {std::tuple{&p, &c, r1},
                                         {&q, &c, r2},
                                         {&c, &mark, std::hypot(0.3, 0.7)},
                                         {&p, &mark, std::hypot(r1 - 0.3, 0.7)}}) {
    const Vector2d e = to->position - from->position;
    const Vector2d rate = to->velocity - from->velocity;
    RC_ASSERT(std::abs(e.norm() - length) < position_rounding);
    RC_ASSERT(std::abs(e.dot(rate)) < speed_rounding * (1 + rate.norm()));
    RC_ASSERT(std::abs(e.dot(to->acceleration - from->acceleration) + rate.squaredNorm()) <
              acceleration_rounding * (1 + rate.squaredNorm()));
  }

  // Angles of the links, and their rates from the ends of the bars: e × ė = ω e², e × ë = α e².
  const auto check_body = [&](const BodyState& body, const PointState& from, const PointState& to) {
    const Vector2d e = to.position - from.position;
    RC_ASSERT(std::abs(cross(e, Vector2d(std::cos(body.angle), std::sin(body.angle)))) < position_rounding);
    RC_ASSERT(e.dot(Vector2d(std::cos(body.angle), std::sin(body.angle))) > 0);
    RC_ASSERT(std::abs(cross(e, to.velocity - from.velocity) - body.omega * e.squaredNorm()) <
              speed_rounding * (1 + std::abs(body.omega)));
    RC_ASSERT(std::abs(cross(e, to.acceleration - from.acceleration) - body.alpha * e.squaredNorm()) <
              acceleration_rounding * (1 + std::abs(body.alpha) + body.omega * body.omega));
  };
  check_body(here.bodies[2], c, p);
  check_body(here.bodies[3], q, c);
}

}  // namespace
}  // namespace oblique::mechanism
