// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/assembly.h>

#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A 3-4-5 triangle standing on A and D, with C at (1.8, ±2.4), and a mark M of AC one to the left of its
/// middle.
std::string truss(const std::string& sketch, double frame = 5) {
  return "format = \"oblique-mechanism/1\"\n[units]\nlength = \"mm\"\n[frame]\nA = [0, 0]\nD = [" +
         std::to_string(frame) +
         ", 0]\n[bodies]\nAC = { points = [\"A\", \"C\"], length = 3, marks = { M = [1.5, 1] } }\n"
         "CD = { points = [\"C\", \"D\"], length = 4 }\n[sketch]\n" +
         sketch;
}

Structure structure_of(const std::string& text) {
  return decompose(parse_mechanism(text, "truss.toml"));
}

int side(const Structure& structure) {
  return structure.groups.at(0).side;
}

std::pair<MechanismError::Kind, std::string> refusal(const std::string& text) {
  try {
    structure_of(text);
  } catch (const MechanismError& error) {
    return {error.kind(), error.what()};
  }
  return {MechanismError::Kind::file, "not refused"};
}

// Wherever it stands in the list.
TEST(FrameConfiguration, GivesAPlaceToTheFrameAlone) {
  Mechanism mechanism;
  mechanism.points = {{"B", false, {1, 2}}, {"A", true, {3, 4}}, {"C", false, {5, 6}}};
  mechanism.bodies.resize(1);
  const Configuration here = frame_configuration(mechanism);
  EXPECT_TRUE(here.points.at(0).position.array().isNaN().all());
  EXPECT_EQ(here.points.at(1).position, Eigen::Vector2d(3, 4));
  EXPECT_EQ(here.points.at(1).velocity, Eigen::Vector2d(0, 0));
  EXPECT_TRUE(here.points.at(2).position.array().isNaN().all());
  EXPECT_TRUE(std::isnan(here.bodies.at(0).cosine));
}

TEST(AssemblyMode, IsTheOneNearerToTheSketch) {
  EXPECT_EQ(side(structure_of(truss("C = [3, 0.1]"))), 1);
  EXPECT_EQ(side(structure_of(truss("C = [3, -0.1]"))), -1);
  // M lies at (0.1, 1.8) with C above, at (1.7, −0.6) with C below
  EXPECT_EQ(side(structure_of(truss("M = [0, 2]"))), 1);
  EXPECT_EQ(side(structure_of(truss("M = [2, -1]"))), -1);
}

TEST(AssemblyMode, WeighsAllSketchedPointsOfTheGroup) {
  // C is nearer to the upper mode by little, M to the lower by much
  EXPECT_EQ(side(structure_of(truss("C = [1.8, 0.1]\nM = [1.7, -0.6]"))), -1);
}

TEST(AssemblyMode, WithoutASketchIsAnErrorThatListsBoth) {
  const auto [kind, text] = refusal(truss("A = [0, 0]"));
  EXPECT_EQ(kind, MechanismError::Kind::sketch);
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("truss.toml:8:1: dyad 'AC-CD' has two assembly modes and no point in [sketch]"),
            HasSubstr("C = [1.8, 2.4]   # left of A → D"), HasSubstr("C = [1.8, -2.4]   # right of A → D")));
}

TEST(AssemblyMode, IsNotGuessedFromAnUndecidedSketch) {
  const auto [kind, text] = refusal(truss("C = [3, 0]"));
  EXPECT_EQ(kind, MechanismError::Kind::sketch);
  EXPECT_THAT(text, HasSubstr("the sketch is equally far from both assembly modes of dyad 'AC-CD'"));
}

TEST(AssemblyMode, IsNotChosenAtADeadCentre) {
  const auto [kind, text] = refusal(truss("C = [3, 1]", 7));
  EXPECT_EQ(kind, MechanismError::Kind::sketch);
  EXPECT_THAT(text, HasSubstr("dyad 'AC-CD' is at a dead centre at the start"));
}

// Rods of √5, 2 and √5 that meet in (2, 4) carry a bar from (1, 2) to (3, 2): by symmetry it can turn about
// that point to first order, so two modes meet. Below the line of pivots it is a dead centre too, and a
// third.
TEST(AssemblyMode, IsNotChosenAtADeadCentreBesideOtherModes) {
  const auto [kind, text] = refusal(R"toml(format = "oblique-mechanism/1"
[frame]
O = [-0.3, 0]
G2 = [2, 0]
G3 = [4, 0]
[bodies]
crank = { points = ["O", "A"], length = 0.3 }
leg1 = { points = ["A", "P1"], length = "sqrt(5)" }
leg2 = { points = ["G2", "P2"], length = 2 }
leg3 = { points = ["G3", "P3"], length = "sqrt(5)" }
plat = { points = ["P1", "P2"], length = 1, marks = { P3 = [2, 0] } }
[drives]
crank = { turns = "crank", about = "O", speed = 1 }
[sketch]
P1 = [1, 2]
P2 = [2, 2]
)toml");
  EXPECT_EQ(kind, MechanismError::Kind::sketch);
  EXPECT_THAT(text, HasSubstr("group 'leg1-leg2-leg3-plat' is at a dead centre at the start: two of its "
                              "assembly modes coincide"));
  EXPECT_THAT(text, HasSubstr("start the drive at another place and sketch that position"));
}

TEST(AssemblyMode, OfLinksThatDoNotReachIsAnAssemblyError) {
  const auto [kind, text] = refusal(truss("C = [3, 1]", 7.5));
  EXPECT_EQ(kind, MechanismError::Kind::assembly);
  EXPECT_THAT(
      text,
      AllOf(
          HasSubstr("dyad 'AC-CD' cannot be assembled at the start: its pivots 'A' and 'D' are 7.5 mm apart"),
          HasSubstr("'AC' (A to C: 3 mm)"), HasSubstr("'CD' (D to C: 4 mm)"),
          HasSubstr("expected a distance of the pivots from 1 to 7 mm")));
  EXPECT_EQ(refusal(truss("C = [3, 1]", 0.5)).first, MechanismError::Kind::assembly);
}

// Two trusses without sketch on the same frame, and one that hangs on the first.
TEST(AssemblyMode, IsReportedForAllIndependentDyadsInOneGo) {
  const std::string text = truss("A = [0, 0]");
  const std::size_t at = text.find("[sketch]");
  try {
    structure_of(text.substr(0, at) + R"(AE = { points = ["A", "E"], length = 3 }
ED = { points = ["E", "D"], length = 4 }
CF = { points = ["C", "F"], length = 3 }
FD = { points = ["F", "D"], length = 4 }
)");
    FAIL();
  } catch (const MechanismError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2U) << error.what();
    EXPECT_THAT(error.what(), AllOf(HasSubstr("'AC-CD'"), HasSubstr("'AE-ED'"), Not(HasSubstr("'CF-FD'"))));
  }
}

/// Two plates on one pin, B, with two bars from one to the other: a bar too many between them, and nothing
/// that keeps them from turning about B. The lengths let it close: P = (1, 0), Q = (0, 1), R = (2, 1), S =
/// (1, 2) about B.
std::string plates_on(const std::string& second_pin) {
  return "format = \"oblique-mechanism/1\"\n[frame]\nA = [0, 0]\nB = [1, 0]\nD = " + second_pin +
         R"toml(
[bodies]
u = { points = ["B", "P"], length = 1, marks = { Q = [0, 1] } }
v = { points = ["D", "R"], length = "sqrt(5)", marks = { S = ["4/sqrt(5)", "3/sqrt(5)"] } }
PR = { points = ["P", "R"], length = "sqrt(2)" }
QS = { points = ["Q", "S"], length = "sqrt(2)" }
[sketch]
P = [2, 0]
Q = [1, 1]
R = [3, 1]
S = [2, 2]
)toml";
}

TEST(AssemblyMode, IsNoneOfAGroupThatTurnsAboutItsOnlyPlace) {
  const auto [kind, text] = refusal(plates_on("[1, 0]"));
  EXPECT_EQ(kind, MechanismError::Kind::constraint);
  EXPECT_THAT(text,
              HasSubstr("has all its joints with the rest in one place, at 'B': it turns about it while the "
                        "drives stand still"));
  EXPECT_THAT(text, HasSubstr("remedy: move one of these joints to another place"));
  EXPECT_THAT(refusal(plates_on("[1.1, 0]")).second, Not(HasSubstr("in one place")));
}

// A dyad of two equal bars over one place, and one of two different bars, which do not close there.
TEST(AssemblyMode, OfADyadOverOnePlace) {
  const auto dyad = [](const char* second) {
    return std::string("format = \"oblique-mechanism/1\"\n[frame]\nA = [1, 2]\nD = [1, 2]\n[bodies]\n") +
           "AC = { points = [\"A\", \"C\"], length = 3 }\nCD = { points = [\"C\", \"D\"], length = " +
           second + " }\n[sketch]\nC = [4, 2]\n";
  };
  const auto [kind, text] = refusal(dyad("3"));
  EXPECT_EQ(kind, MechanismError::Kind::constraint);
  EXPECT_THAT(text, HasSubstr("dyad 'AC-CD' has all its joints with the rest in one place, at 'A'"));
  EXPECT_EQ(refusal(dyad("4")).first, MechanismError::Kind::assembly);
}

// The link CDFH on rods to E and G, and P and Q on rods to each other, to the frame and to the link: seven
// conditions for three unknowns of the link and two of each free point, which no part of them gives.
TEST(AssemblyModes, OfAGroupOfABodyAndTwoFreePoints) {
  const std::map<std::string, Eigen::Vector2d> places{
      {"A", {1, 0}},     {"B", {6, 0}},     {"C", {2.2, 4}}, {"D", {4.4, 4.1}}, {"E", {-0.5, 5.5}},
      {"F", {3.0, 5.0}}, {"G", {7.2, 6.0}}, {"H", {4, 5.2}}, {"P", {1.5, 2.0}}, {"Q", {5.0, 2.2}}};
  const Eigen::Vector2d x = (places.at("D") - places.at("C")).normalized(), y(-x.y(), x.x());
  const auto local = [&](const std::string& point) {
    const Eigen::Vector2d arm = places.at(point) - places.at("C");
    return fmt::format("{} = [{:.17g}, {:.17g}]", point, x.dot(arm), y.dot(arm));
  };
  const auto length = [&](const std::string& rod) {
    return (places.at(rod.substr(0, 1)) - places.at(rod.substr(1))).norm();
  };
  std::string text = "format = \"oblique-mechanism/1\"\n[frame]\n";
  for (const std::string point : {"A", "B", "E", "G"})
    text += fmt::format("{} = [{}, {}]\n", point, places.at(point).x(), places.at(point).y());
  text += fmt::format("[bodies]\nK = {{ points = [\"C\", \"D\"], length = {:.17g}, marks = {{ {}, {} }} }}\n",
                      length("CD"), local("F"), local("H"));
  for (const std::string rod : {"AP", "BQ", "PC", "QD", "PQ", "EF", "GH"})
    text += fmt::format("{} = {{ points = [\"{}\", \"{}\"], length = {:.17g} }}\n", rod, rod[0], rod[1],
                        length(rod));
  text += "[sketch]\n";
  for (const std::string point : {"C", "D", "P", "Q"})
    text += fmt::format("{} = [{}, {}]\n", point, places.at(point).x() + 0.1, places.at(point).y() - 0.1);
  const Mechanism mechanism = parse_mechanism(text, "truss.toml");
  const Structure structure = decompose(mechanism);
  ASSERT_EQ(structure.groups.size(), 1U);
  const Configuration here = start_configuration(mechanism, structure);
  for (const auto& [point, place] : places) {
    const Eigen::Vector2d& found = here.points[mechanism.find_point(point).value()].position;
    EXPECT_LT((found - place).norm(), 1e-12)
        << point;  // roundings of numbers near 7, through seven conditions
  }
}

TEST(AssemblyModes, AreOneForACrankAndTwoForADyad) {
  const Mechanism four_bar =
      read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml");
  const Structure structure = decompose(four_bar);
  const auto groups = assembly_modes(four_bar, structure, std::array{DriveState{0, 1, 0}},
                                     start_configuration(four_bar, structure));
  ASSERT_EQ(groups.size(), 2U);
  ASSERT_EQ(groups[0].modes.size(), 1U);
  EXPECT_EQ(groups[0].modes[0].positions[0], Eigen::Vector2d(1, 0));
  ASSERT_EQ(groups[1].modes.size(), 2U);
  EXPECT_TRUE(groups[1].modes[0].selected);
  EXPECT_FALSE(groups[1].modes[1].selected);
  ASSERT_EQ(groups[1].modes[0].points.size(), 2U);  // C and the mark M
  // C over BD = 3: x = 1 + (9 + 3.5² − 3²)/6 = 73/24, mirrored in y; a few roundings of numbers near 3
  EXPECT_NEAR(groups[1].modes[0].positions[0].x(), 73.0 / 24, 1e-15);
  EXPECT_NEAR(groups[1].modes[1].positions[0].x(), 73.0 / 24, 1e-15);
  EXPECT_EQ(groups[1].modes[0].positions[0].y(), -groups[1].modes[1].positions[0].y());
}

TEST(AssemblyModes, AreNoneWhereTheLinksDoNotReach) {
  Mechanism mechanism = parse_mechanism(truss("C = [3, 1]"), "truss.toml");
  const Structure structure = decompose(mechanism);
  mechanism.points[1].position.x() = 8;
  EXPECT_TRUE(assembly_modes(mechanism, structure, {}, start_configuration(mechanism, structure))
                  .at(0)
                  .modes.empty());
}

}  // namespace
}  // namespace oblique::mechanism
