// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/rank.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/mechanism/structure/redundancy.h>
#include <oblique/mechanism/structure/structure.h>

#include "../support/chain_of_dyads.h"
#include "mechanism_text.h"

namespace oblique::mechanism {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Mechanism parallelogram(const std::string& start, const std::string& sketch) {
  return mechanism(fmt::format(R"([frame]
A = [0, 0]
D = [80, 0]
[bodies]
AB = {{ points = ["A", "B"], length = 40 }}
BC = {{ points = ["B", "C"], length = 80 }}
DC = {{ points = ["D", "C"], length = 40 }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1, start = "{}" }}
[sketch]
C = {}
)",
                               start, sketch));
}

/// A parallelogram with a third crank FE of this length, pinned halfway.
Mechanism three_cranks(double length, const std::string& order = R"("F", "E")") {
  return mechanism(fmt::format(R"([units]
length = "mm"
[frame]
A = [0, 0]
D = [80, 0]
F = [40, 0]
[bodies]
AB  = {{ points = ["A", "B"], length = 40 }}
BCE = {{ points = ["B", "C"], length = 80, marks = {{ E = [40, 0] }} }}
DC  = {{ points = ["D", "C"], length = 40 }}
FE  = {{ points = [{}], length = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = "60 rpm", start = "60.5 deg" }}
[sketch]
C = [100, 35]
)",
                               order, length));
}

std::string refusal(const Mechanism& mechanism) {
  try {
    decompose(mechanism);
  } catch (const MechanismError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Rank, IsWhatGrueblersFormulaSaysOfTheShippedMechanisms) {
  for (const char* name : {"four-bar", "six-bar", "jansen"}) {
    const Mechanism shipped =
        read_mechanism(fmt::format("{}/diagrams/mechanisms/{}.toml", OBLIQUE_SOURCE_DIR, name));
    const MobilityReport report = mobility_report(shipped, decompose(shipped));
    EXPECT_EQ(report.start.mobility(), 1) << name;
    EXPECT_EQ(report.start.gruebler(), report.gruebler) << name;
    EXPECT_EQ(report.verdict, MobilityReport::Verdict::agrees);
    EXPECT_FALSE(report.beside);
  }
}

// Jacobi's method takes up to a hundred conditions, another one more.
TEST(Rank, IsFoundOfManyLinksToo) {
  for (const int n : {10, 20}) {  // 62 and 122 conditions
    const Mechanism chain = mechanism(test::chain_of_dyads(n));
    const MobilityReport report = mobility_report(chain, decompose(chain));
    EXPECT_EQ(report.start.mobility(), 1);
    EXPECT_EQ(report.start.rank, static_cast<std::size_t>(6 * n + 2));
    EXPECT_EQ(report.start.largest_lost, 0);
  }
}

// Columns of the Jacobian against differences of the conditions: a point moves on a prismatic joint of a
// moving link.
TEST(Rank, CountsSlides) {
  const Mechanism whitworth = mechanism(R"([frame]
A = [0, 0]
D = [0, -60]
X = [400, -60]
[bodies]
AB    = { points = ["A", "B"], length = 100 }
lever = { points = ["D", "S"], length = 180, marks = { E = [-80, 0] } }
rod   = { points = ["E", "C"], length = 250 }
[slides]
slot = { point = "B", along = ["D", "S"] }
ram  = { point = "C", along = ["D", "X"] }
[drives]
crank = { turns = "AB", about = "A", speed = "60 rpm", start = "0 deg" }
[sketch]
S = [154, 33]
C = [175, -60]
)");
  const Structure structure = decompose(whitworth);
  const Configuration here = start_configuration(whitworth, structure);
  const auto poses = poses_of(whitworth, here);
  const JacobianRank rank = jacobian_rank(whitworth, poses);
  EXPECT_EQ(rank.mobility(), 1);
  EXPECT_EQ(rank.conditions, 8U);
  // the velocities of the motion are in its null space
  const Eigen::MatrixXd jacobian = pair_jacobian(whitworth, poses);
  Eigen::VectorXd rates(9);
  for (std::size_t b = 0; b < 3; ++b) {
    const auto k = static_cast<Eigen::Index>(3 * b);
    rates.segment<2>(k) = here.points[whitworth.bodies[b].points.front().point].velocity;
    rates(k + 2) = here.bodies[b].omega * whitworth.largest_length();
  }
  EXPECT_LT((jacobian * rates).norm(), 1e-10 * rates.norm());
}

TEST(Rank, OfAParallelogramAtItsChangePointIsLowerThere) {
  const Mechanism parallel = parallelogram("60 deg", "[100, 35]");
  const auto flat = [](double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return std::vector<BodyPose>{{{0, 0}, c, s}, {{40 * c, 40 * s}, 1, 0}, {{80, 0}, c, s}};
  };
  EXPECT_EQ(jacobian_rank(parallel, flat(0)).mobility(), 2);
  EXPECT_EQ(jacobian_rank(parallel, flat(std::numbers::pi)).mobility(), 2);
  EXPECT_EQ(jacobian_rank(parallel, flat(0.1)).mobility(), 1);
}

// Next to its change point it still has modes to tell apart, and its rank is lower; 5° on it is not, however
// long the drive takes to get there.
TEST(Rank, NextToAChangePointIsHigherALittleOn) {
  const double start = 1e-6, on = start + 5 * std::numbers::pi / 180;
  const double c = std::cos(on), s = std::sin(on);
  for (const double speed : {1e-6, 1.0, 1e3}) {
    Mechanism parallel = parallelogram("1e-6 rad", "[120, 40]");
    parallel.drives.front().speed = speed;
    const MobilityReport report = mobility_report(parallel, decompose(parallel));
    EXPECT_EQ(report.verdict, MobilityReport::Verdict::shaky) << speed;
    EXPECT_EQ(report.start.mobility(), 2);
    ASSERT_TRUE(report.beside);
    EXPECT_EQ(report.beside->mobility(), 1);
    const JacobianRank there =
        jacobian_rank(parallel, {{{0, 0}, c, s}, {{40 * c, 40 * s}, 1, 0}, {{80, 0}, c, s}});
    EXPECT_NEAR(report.beside->least_kept, there.least_kept, 1e-9);  // places are known to roundings
  }
}

TEST(Rank, StartAtAChangePointIsCalledShaky) {
  EXPECT_THAT(
      refusal(parallelogram("0 deg", "[120, 0]")),
      HasSubstr("is at a dead centre at the start: its assembly modes coincide, and it is shaky: by rank "
                "its mobility is 2 there, by Grübler's formula 1"));
}

// The third crank closes for all positions of the first.
TEST(Redundancy, OfAThirdParallelCrankCloses) {
  for (const char* order : {R"("F", "E")", R"("E", "F")"}) {
    const Mechanism cranks = three_cranks(40, order);
    const Redundancy redundancy = examine_redundancy(cranks).value();
    ASSERT_EQ(redundancy.excesses.size(), 1U);
    EXPECT_TRUE(redundancy.closes_at_start);
    EXPECT_TRUE(redundancy.closes_beside);
    EXPECT_EQ(redundancy.mobility, 1);
    EXPECT_EQ(mobility(cranks), 0);
    EXPECT_LT(redundancy.excesses[0].miss_beside, 1e-12);
    EXPECT_THAT(refusal(cranks), AllOf(HasSubstr("the mechanism has mobility 0"),
                                       HasSubstr("in the loop AB-BCE-DC-FE is redundant: "
                                                 "it closes all the same, and by rank the "
                                                 "mechanism has mobility 1"),
                                       HasSubstr("the others move alike without that body: leave it out")));
  }
}

TEST(Redundancy, OfACrankThatIsTooLongIsContradictory) {
  const Redundancy redundancy = examine_redundancy(three_cranks(42.5)).value();
  EXPECT_FALSE(redundancy.closes_at_start);
  EXPECT_FALSE(redundancy.mobility);
  EXPECT_NEAR(redundancy.excesses.at(0).miss_at_start, 2.5, 1e-12);
  EXPECT_THAT(
      refusal(three_cranks(42.5)),
      AllOf(
          HasSubstr(
              "test.toml:12:1: the revolute joint of 'FE' at 'E' in the loop AB-BCE-DC-FE is contradictory: "
              "without it the others leave 2.5 mm there"),
          HasSubstr("leave it out, or correct a length")));
}

// |FE| fits at the start and nowhere else: its pivot lies beside the line of the others'.
TEST(Redundancy, ThatClosesAtTheStartOnlyLocks) {
  const double start = 60.5 * std::numbers::pi / 180;
  const Eigen::Vector2d e(40 * std::cos(start) + 40, 40 * std::sin(start));
  Mechanism cranks = three_cranks((e - Eigen::Vector2d(40, -10)).norm());
  cranks.points[cranks.find_point("F").value()].position = {40, -10};
  const Redundancy redundancy = examine_redundancy(cranks).value();
  EXPECT_TRUE(redundancy.closes_at_start);
  EXPECT_FALSE(redundancy.closes_beside);
  EXPECT_EQ(redundancy.mobility, 0);
  EXPECT_THAT(refusal(cranks),
              AllOf(HasSubstr("closes at the start only"), HasSubstr("so it locks the mechanism")));
}

// A piston on two parallel guides.
TEST(Redundancy, OfASecondGuide) {
  const auto guided = [](double offset) {
    return mechanism(fmt::format(R"([frame]
A = [0, 0]
X = [9, 0]
[bodies]
AB = {{ points = ["A", "B"], length = 1 }}
BC = {{ points = ["B", "C"], length = 3 }}
[slides]
upper = {{ point = "C", along = ["A", "X"] }}
lower = {{ point = "C", along = ["A", "X"], offset = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1, start = "20 deg" }}
[sketch]
C = [4, 0]
)",
                                 offset));
  };
  const Redundancy same = examine_redundancy(guided(0)).value();
  EXPECT_TRUE(same.closes_beside);
  EXPECT_EQ(same.mobility, 1);
  const Redundancy apart = examine_redundancy(guided(0.25)).value();
  EXPECT_FALSE(apart.closes_at_start);
  EXPECT_NEAR(apart.excesses.at(0).miss_at_start, 0.25, 1e-12);
  EXPECT_THAT(refusal(guided(0)), HasSubstr("slide 'lower' in the loop"));
}

// Where a second drive of the same crank is what is too much, no joint is redundant.
TEST(Redundancy, IsNotLookedForWhereADriveIsTooMuch) {
  Mechanism driven_twice = parallelogram("60 deg", "[100, 35]");
  Drive second = driven_twice.drives.front();
  second.name = "second";
  driven_twice.drives.push_back(second);
  EXPECT_FALSE(examine_redundancy(driven_twice));
  EXPECT_THAT(refusal(driven_twice), Not(HasSubstr("redundant")));
}

TEST(Redundancy, IsNotLookedForWhereNothingIsTooMuch) {
  EXPECT_FALSE(examine_redundancy(parallelogram("60 deg", "[100, 35]")));
  EXPECT_THAT(refusal(parallelogram("60 deg", "[100, 35]")), Not(HasSubstr("redundant")));
}

}  // namespace
}  // namespace oblique::mechanism
