// SPDX-License-Identifier: MIT
// Bodies and points as the unknowns of a group move them. The unknowns and what the group hangs on move here
// as they are told to, so that rates are differences of positions.
#include <oblique/mechanism/solver/group_bodies.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <oblique/mechanism/structure/structure.h>

#include "../mechanism_text.h"

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

PointState parabola(double t, const Vector2d& from, const Vector2d& velocity, const Vector2d& acceleration) {
  return {from + t * velocity + t * t / 2 * acceleration, velocity + t * acceleration, acceleration};
}

/// An angle that goes on as `from` + 0.9 t − 0.3 t².
BodyState turning(double t, double from) {
  const double angle = from + 0.9 * t - 0.3 * t * t;
  return {angle, 0.9 - 0.6 * t, -0.6, std::cos(angle), std::sin(angle)};
}

/// A point at a fixed distance from another, in a direction that turns.
PointState carried(const PointState& from, const BodyState& turn, double length) {
  const Vector2d way = length * Vector2d(turn.cosine, turn.sine), across(-way.y(), way.x());
  return {from.position + way, from.velocity + turn.omega * across,
          from.acceleration + turn.alpha * across - turn.omega * turn.omega * way};
}

/// Positions agree with the geometry by themselves; rates of all that the group has placed are differences
/// over 1e-3 s, off by 1e-6 of the third and fourth derivatives, which are of order 10.
template <class Configurations>
void expect_rates(const Group& group, const Configurations& at) {
  constexpr double kStep = 1e-3, kOff = 1e-4;
  const Configuration before = at(-kStep), here = at(0), after = at(kStep);
  for (const std::size_t p : group.points) {
    const Vector2d velocity = (after.points[p].position - before.points[p].position) / (2 * kStep);
    const Vector2d acceleration =
        (after.points[p].position - 2 * here.points[p].position + before.points[p].position) /
        (kStep * kStep);
    EXPECT_LT((here.points[p].velocity - velocity).norm(), kOff) << "point " << p;
    EXPECT_LT((here.points[p].acceleration - acceleration).norm(), kOff) << "point " << p;
    EXPECT_GT(velocity.norm(), 0.1) << "else nothing is shown";
  }
  for (const std::size_t b : group.bodies) {
    const auto angle = [&](const Configuration& c) {
      return std::atan2(c.bodies[b].sine, c.bodies[b].cosine);
    };
    const double first = angle(before), middle = angle(here), last = angle(after);
    EXPECT_NEAR(here.bodies[b].omega, (last - first) / (2 * kStep), kOff) << "body " << b;
    EXPECT_NEAR(here.bodies[b].alpha, (last - 2 * middle + first) / (kStep * kStep), kOff) << "body " << b;
    EXPECT_NEAR(std::hypot(here.bodies[b].cosine, here.bodies[b].sine), 1, 1e-15) << "body " << b;
  }
}

/// Whether a point stands where its body, by its direction and another of its points, has it.
void expect_carried(const Mechanism& mechanism, const Configuration& here, const char* body, const char* from,
                    const char* to) {
  const std::size_t b = mechanism.find_body(body).value();
  const std::size_t p = mechanism.find_point(from).value(), q = mechanism.find_point(to).value();
  const Vector2d local = mechanism.bodies[b].find(q)->local - mechanism.bodies[b].find(p)->local;
  const Eigen::Rotation2Dd turn(std::atan2(here.bodies[b].sine, here.bodies[b].cosine));
  EXPECT_LT((here.points[q].position - here.points[p].position - turn * local).norm(), 1e-15 * 10)
      << body << ": " << from << " " << to;
}

// A platform on three legs; the x axis of DE is not the way between its joints.
TEST(GroupBodies, OfAPlatformAndItsLegsMoveAsOne) {
  const Mechanism triad = mechanism(R"([frame]
O = [0, 0]
P = [0, 1.2]
E = [1.46, 0.824]
[bodies]
OA  = { points = ["O", "A"], length = 0.3 }
AB  = { points = ["B", "A"], length = 1.07, marks = { M = [0.4, 0.3] } }
BCD = { points = ["B", "D"], length = 0.665, marks = { C = [0.825, -0.581] } }
DE  = { points = ["N", "E"], length = 0.5, marks = { D = [-0.1, 0.4] } }
PC  = { points = ["P", "C"], length = 1.945, marks = { Q = [1, -0.4] } }
[drives]
crank = { turns = "OA", about = "O", speed = 1 }
[sketch]
B = [1.2242, -0.5391]
D = [1.1722, 0.1238]
C = [1.739, 0.3288]
)");
  const Structure structure = decompose(triad);
  const Group& group = structure.groups.at(1);
  ASSERT_EQ(group.equations.platforms.size(), 1U);
  ASSERT_EQ(group.equations.binary_links.size(), 3U);
  const GroupBodies bodies(triad, group);
  const auto at = [&](double t) {
    const PointState b = parabola(t, {1.2, -0.5}, {0.6, 0.3}, {-0.8, 0.4});
    const BodyState turn = turning(t, 1.1);
    Configuration here = frame_configuration(triad);
    // the other ends of the legs, from those on the platform
    here.points[triad.find_point("A").value()] = carried(b, turning(t, 2.5), 1.07);
    const PointState c = carried(b, turning(t, 1.1 + std::atan2(-0.581, 0.825)), std::hypot(0.825, 0.581));
    here.points[triad.find_point("P").value()] = carried(c, turning(t, -2.2), 1.945);
    here.points[triad.find_point("E").value()] =
        carried(carried(b, turn, 0.665), turning(t, 0.3), std::hypot(0.6, 0.4));
    GroupState state(group.equations);
    state.platforms[0] = {b, turn.cosine, turn.sine, turn.omega, turn.alpha};
    bodies.place(state, here);
    return here;
  };
  expect_rates(group, at);
  const Configuration here = at(0);
  EXPECT_EQ(here.points[triad.find_point("B").value()].position, Vector2d(1.2, -0.5));
  expect_carried(triad, here, "BCD", "B", "C");
  expect_carried(triad, here, "BCD", "B", "D");
  // Of a leg the ends stand where they are, and what it carries lies beside the straight way between them.
  for (const auto& [body, from, to] : {std::array{"AB", "B", "A"}, {"PC", "P", "C"}}) {
    const BodyState& leg = here.bodies[triad.find_body(body).value()];
    const Vector2d way = here.points[triad.find_point(to).value()].position -
                         here.points[triad.find_point(from).value()].position;
    EXPECT_LT((Vector2d(leg.cosine, leg.sine) - way.normalized()).norm(), 1e-14) << body;
  }
  expect_carried(triad, here, "DE", "D", "E");
  expect_carried(triad, here, "DE", "D", "N");
  expect_carried(triad, here, "PC", "P", "Q");
}

// The pin P in two blocks: S slides on the crank AB and stands at 30° to it, T at 50° to the frame.
TEST(GroupBodies, OfBlocksTurnWithWhatTheySlideOn) {
  const Mechanism pin = mechanism(R"([frame]
A = [0, 0]
D = [0, 3]
E = [9, 3]
[bodies]
AB = { points = ["A", "B"], length = 5 }
S = { points = ["P", "K"], length = 1 }
T = { points = ["P", "L"], length = 1.5 }
[slides]
ray  = { point = "K", along = ["A", "B"], of = "S", angle = "30 deg" }
line = { point = "L", along = ["D", "E"], of = "T", angle = "50 deg" }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "45 deg" }
)");
  const Structure structure = find_groups(pin);
  const Group& group = structure.groups.at(1);
  ASSERT_EQ(group.equations.blocks.size(), 2U);
  const GroupBodies bodies(pin, group);
  const auto at = [&](double t) {
    Configuration here = frame_configuration(pin);
    here.bodies[pin.find_body("AB").value()] = turning(t, 0.7);
    GroupState state(group.equations);
    state.free.at(0) = parabola(t, {3, 3}, {0.5, -0.3}, {0.9, 0.2});
    bodies.place(state, here);
    return here;
  };
  expect_rates(group, at);
  const Configuration here = at(0);
  const BodyState& s = here.bodies[pin.find_body("S").value()];
  const BodyState& t = here.bodies[pin.find_body("T").value()];
  EXPECT_NEAR(std::atan2(s.sine, s.cosine), 0.7 + std::numbers::pi / 6, 1e-15);
  EXPECT_NEAR(std::atan2(t.sine, t.cosine), 5 * std::numbers::pi / 18, 1e-15);
  EXPECT_EQ(t.omega, 0);
  expect_carried(pin, here, "S", "P", "K");
  expect_carried(pin, here, "T", "P", "L");
}

}  // namespace
}  // namespace oblique::mechanism
