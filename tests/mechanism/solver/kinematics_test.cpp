// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/kinematics.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "../mechanism_text.h"

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

/// A crank that stands at 0.4 at time 0, turns at 1.3 rad/s and gains 0.7 rad/s².
DriveState drive_at(double t) {
  return {0.4 + 1.3 * t + 0.35 * t * t, 1.3 + 0.7 * t, 0.7};
}

/// A four-bar whose coupler carries a slot beside its base, on which the pin T of the bar GT slides.
Mechanism slotted_coupler() {
  return mechanism(R"([frame]
A = [0, 0]
D = [4, 0]
G = [2, 5]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5, marks = { K = [0.5, 0.6], L = [2.5, 1.1] } }
CD = { points = ["C", "D"], length = 3 }
GT = { points = ["G", "T"], length = 3 }
[slides]
pin = { point = "T", along = ["K", "L"], offset = 0.2 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
[sketch]
C = [3.5, 2.9]
T = [3.5, 3.2]
)");
}

class SlottedCoupler : public ::testing::Test {
 protected:
  Configuration at(double t) {
    const std::vector<DriveState> drives{drive_at(t)};
    kinematics_.place(drives, here_);
    kinematics_.finish(drives, here_);
    return here_;
  }
  Vector2d place(const Configuration& here, const char* point) const {
    return here.points[mechanism_.find_point(point).value()].position;
  }

  const Mechanism mechanism_ = slotted_coupler();
  const Structure structure_ = decompose(mechanism_);
  Kinematics kinematics_{mechanism_, structure_};
  Configuration here_ = frame_configuration(mechanism_);
};

// How far T is along K → L follows from the three points; its rates are differences of that over 1e-4 s,
// which are off by 1e-8 of the third and fourth derivatives, and by 1e-16/1e-8 of rounding.
TEST_F(SlottedCoupler, TellsHowFarThePinIsAndHowItMoves) {
  const auto way = [&](double t) {
    const Configuration here = at(t);
    return (place(here, "L") - place(here, "K")).normalized().dot(place(here, "T") - place(here, "K"));
  };
  constexpr double kStep = 1e-4;
  for (const double t : {0.0, 0.7, 1.9, 3.1}) {
    const SlideState slide = at(t).slides.at(0);
    const double before = way(t - kStep), there = way(t), after = way(t + kStep);
    EXPECT_NEAR(slide.position, there, 1e-14) << t;
    EXPECT_NEAR(slide.velocity, (after - before) / (2 * kStep), 1e-5) << t;
    EXPECT_NEAR(slide.acceleration, (after - 2 * there + before) / (kStep * kStep), 1e-4) << t;
    EXPECT_GT(std::abs(slide.velocity), 1e-2) << "else nothing is shown";
  }
}

TEST_F(SlottedCoupler, GivesAnglesOfFirstToSecondPointAndThatOfTheDrive) {
  for (const double t : {0.0, 2.5, 6.0}) {
    const Configuration here = at(t);
    EXPECT_EQ(here.bodies[0].angle, drive_at(t).value) << "however many turns";
    for (const std::size_t body : {1U, 2U, 3U}) {
      const Body& bar = mechanism_.bodies[body];
      const Vector2d way =
          here.points[bar.points[1].point].position - here.points[bar.points[0].point].position;
      EXPECT_NEAR(here.bodies[body].angle, std::atan2(way.y(), way.x()), 1e-14) << bar.name;
    }
  }
}

TEST_F(SlottedCoupler, StartsWhereItsDriveDoes) {
  const Configuration start = start_configuration(mechanism_, structure_);
  EXPECT_EQ(start.status, Status::ok);
  EXPECT_EQ(place(start, "B"), Vector2d(1, 0));
  EXPECT_NEAR((place(start, "C") - Vector2d(1, 0)).norm(), 3.5, 1e-14);
  EXPECT_NEAR((place(start, "C") - Vector2d(4, 0)).norm(), 3, 1e-14);
  EXPECT_EQ(start.bodies[0].omega, 1);
  const Vector2d coupler = place(start, "C") - place(start, "B");
  EXPECT_NEAR(start.bodies[1].angle, std::atan2(coupler.y(), coupler.x()), 1e-14);
}

// The ram's way counts from W, up a slope of 1 : 4.
TEST(Kinematics, GivesADrivenSlideTheStateOfItsDrive) {
  const Mechanism slider = mechanism(R"([frame]
O = [0, 0]
W = [-2, 0]
E = [2, 1]
[bodies]
OQ = { points = ["O", "Q"], length = 0.5 }
QP = { points = ["Q", "P"], length = 1 }
[slides]
guide = { point = "P", along = ["W", "E"] }
[drives]
ram = { slides = "guide", speed = 0.1, start = 2.7 }
[sketch]
Q = [0.3, 0.4]
)");
  const Structure structure = decompose(slider);
  Kinematics kinematics(slider, structure);
  Configuration here = frame_configuration(slider);
  const std::vector<DriveState> drives{{2.8, 0.3, -0.8}};
  kinematics.place(drives, here);
  kinematics.finish(drives, here);
  EXPECT_EQ(here.slides.at(0).position, 2.8);
  EXPECT_EQ(here.slides.at(0).velocity, 0.3);
  EXPECT_EQ(here.slides.at(0).acceleration, -0.8);
  const PointState& pin = here.points[slider.find_point("P").value()];
  EXPECT_NEAR(pin.position.x(), -2 + 2.8 * 4 / std::sqrt(17), 1e-14);
  EXPECT_NEAR(pin.velocity.x(), 0.3 * 4 / std::sqrt(17), 1e-14);
  const Vector2d crank = here.points[slider.find_point("Q").value()].position;
  EXPECT_NEAR(here.bodies[0].angle, std::atan2(crank.y(), crank.x()), 1e-14) << "no drive turns it";
}

// y = 0.3 of the guide from W = (−2, 0.3): x = 0.5 cos φ + √(1 − (0.5 sin φ − 0.3)²) is 2 less than the way.
TEST(Kinematics, TellsHowFarASlideOfTheFrameIs) {
  const Mechanism slider = mechanism(R"([frame]
O = [0, 0]
W = [-2, 0.3]
E = [2, 0.3]
[bodies]
OQ = { points = ["O", "Q"], length = 0.5 }
QP = { points = ["Q", "P"], length = 1 }
[slides]
guide = { point = "P", along = ["W", "E"] }
[drives]
crank = { turns = "OQ", about = "O", speed = 1 }
[sketch]
P = [1.4, 0.3]
)");
  const Structure structure = decompose(slider);
  Kinematics kinematics(slider, structure);
  Configuration here = frame_configuration(slider);
  const auto way = [](double angle) {
    const double rise = 0.5 * std::sin(angle) - 0.3;
    return 2 + 0.5 * std::cos(angle) + std::sqrt(1 - rise * rise);
  };
  for (const double angle : {0.3, 2.0, 5.1}) {
    const std::vector<DriveState> drives{{angle, 1, 0}};
    kinematics.place(drives, here);
    kinematics.finish(drives, here);
    constexpr double kStep = 1e-4;  // as above
    const SlideState& slide = here.slides.at(0);
    EXPECT_NEAR(slide.position, way(angle), 1e-14);
    EXPECT_NEAR(slide.velocity, (way(angle + kStep) - way(angle - kStep)) / (2 * kStep), 1e-6);
    EXPECT_NEAR(slide.acceleration,
                (way(angle + kStep) - 2 * way(angle) + way(angle - kStep)) / (kStep * kStep), 1e-5);
  }
}

// The arm's joint B is carried by a block on two pins beside x = 100, and its slot is on the pin O: two
// bodies that Newton's method finds, from the pose of the sketch at the start. On the right B stands at 112,
// on the left at 88, whatever stood in the configuration before.
TEST(Kinematics, StartsGroupsThatAreFollowedFromThePoseOfTheSketch) {
  const auto start_of = [](const char* sketch) {
    const Mechanism carried = mechanism(std::string(R"([frame]
O = [0, 0]
F = [100, 0]
E = [100, 100]
[bodies]
arm = { points = ["B", "T"], length = 150 }
block = { points = ["B", "L"], length = 20, marks = { K = [0, 15] } }
[slides]
slot = { point = "O", along = ["B", "T"] }
upper = { point = "L", along = ["F", "E"] }
lower = { point = "K", along = ["F", "E"] }
[drives]
crank = { turns = "arm", about = "B", speed = 1, start = "30 deg" }
[sketch]
)") + sketch);
    const Structure structure = decompose(carried);
    const Configuration start = start_configuration(carried, structure);
    EXPECT_EQ(start.status, Status::ok);
    Configuration loaded = frame_configuration(carried);
    Kinematics(carried, structure).load_start(loaded);
    for (std::size_t body = 0; body < 2; ++body) {
      EXPECT_NEAR(loaded.bodies[body].cosine, start.bodies[body].cosine, 1e-12);
      EXPECT_NEAR(loaded.bodies[body].sine, start.bodies[body].sine, 1e-12);
    }
    EXPECT_NEAR(start.bodies[0].cosine, std::cos(std::numbers::pi / 6), 1e-14);
    EXPECT_EQ(loaded.points[carried.find_point("O").value()].position, Vector2d(0, 0));
    return start.points[carried.find_point("B").value()].position;
  };
  const Vector2d along(1, 1 / std::sqrt(3));
  EXPECT_LT((start_of("B = [112, 64]\nL = [100, 80]") - 112 * along).norm(), 1e-12);
  EXPECT_LT((start_of("B = [88, 51]\nL = [100, 35]") - 88 * along).norm(), 1e-12);
}

// A parallelogram, collinear at 180°, and a dyad from its crank to F that does not reach beyond 500: it is
// 460 to F at 0°, and 540 at 180°. The dyad PCQ of the parallelogram comes first.
TEST(Kinematics, NamesTheGroupThatIsNotAsItShouldBe) {
  const auto text = [](const char* far) {
    return std::string(R"([frame]
A = [0, 0]
D = [80, 0]
F = [)") + far +
           R"(, 0]
[bodies]
AB = { points = ["A", "B"], length = 40 }
BC = { points = ["B", "C"], length = 80 }
DC = { points = ["D", "C"], length = 40 }
BE = { points = ["B", "E"], length = 250 }
EF = { points = ["E", "F"], length = 250 }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "60 deg" }
[sketch]
C = [100, 35]
E = [250, 150]
)";
  };
  const auto state_at = [](const Mechanism& bars, double angle) {
    const Structure structure = decompose(bars);
    EXPECT_EQ(structure.groups.size(), 3U);
    EXPECT_EQ(structure.groups.at(1).name, "BC-DC");
    Kinematics kinematics(bars, structure);
    Configuration here = frame_configuration(bars);
    kinematics.place(std::vector<DriveState>{{angle, 1, 0}}, here);
    return here;
  };
  const Mechanism far = mechanism(text("500")), near = mechanism(text("400"));
  const Configuration well = state_at(far, 1);
  EXPECT_EQ(well.status, Status::ok);
  EXPECT_FALSE(well.group);
  const Configuration collinear = state_at(near, std::numbers::pi);
  EXPECT_EQ(collinear.status, Status::dead_centre);
  EXPECT_EQ(collinear.group, 1U);
  EXPECT_NEAR(collinear.points[near.find_point("C").value()].position.x(), 40, 1e-12);
  const Configuration open = state_at(far, std::numbers::pi);  // the parallelogram is collinear there too
  EXPECT_EQ(open.status, Status::open);
  EXPECT_EQ(open.group, 2U);
  EXPECT_TRUE(std::isnan(open.points[far.find_point("C").value()].position.x()));
  EXPECT_EQ(open.points[far.find_point("F").value()].position, Vector2d(500, 0));
  // what a configuration was before says nothing
  const Structure structure = decompose(far);
  Configuration again = open;
  Kinematics(far, structure).place(std::vector<DriveState>{{1, 1, 0}}, again);
  EXPECT_EQ(again.status, Status::ok);
  EXPECT_FALSE(again.group);
}

// A crank and a rod of the same length: at 90° the rod stands upright over the crank's pivot, and touches the
// line of its end at one point to the last bit.
TEST(Kinematics, OfARodThatStandsUprightOnItsLineIsADeadCentre) {
  const Mechanism isosceles = mechanism(R"([frame]
A = [0, 0]
X = [5, 0]
[bodies]
AB = { points = ["A", "B"], length = 2 }
BC = { points = ["B", "C"], length = 2 }
[slides]
piston = { point = "C", along = ["A", "X"] }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "30 deg" }
[sketch]
C = [3.4, 0]
)");
  const Structure structure = decompose(isosceles);
  Kinematics kinematics(isosceles, structure);
  Configuration here = frame_configuration(isosceles);
  const std::vector<DriveState> drives{{std::numbers::pi / 2, 1, 0}};
  kinematics.place(drives, here);
  EXPECT_EQ(here.status, Status::dead_centre);
  EXPECT_NEAR((here.points[isosceles.find_point("C").value()].position).norm(), 0, 1e-15);
}

}  // namespace
}  // namespace oblique::mechanism
