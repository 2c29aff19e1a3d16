// SPDX-License-Identifier: MIT
#include <oblique/patch/patch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/scaling.h>
#include <oblique/patch/triad_split.h>
#include <oblique/solve/run.h>

#include "patched_run.h"

namespace oblique::patch {
namespace {

using ::testing::HasSubstr;

class ShippedMechanism : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Patch, ShippedMechanism, ::testing::Values("four-bar", "six-bar", "jansen"));

TEST_P(ShippedMechanism, KeepsEverySignalWithinOneMachineUnit) {
  const PatchedRun patched(patch_triangles(shipped(GetParam())));
  double largest = 0;
  for (std::size_t s = 0; s < patched.result.peaks.size(); ++s) {
    // Cosines stand at 1 and overshoot by the run's tolerance of 1e-10, accumulated over a thousand steps.
    EXPECT_LE(std::abs(patched.result.peaks[s].value), 1 + 1e-6) << patched.program.signal_names()[s];
    largest = std::max(largest, std::abs(patched.result.peaks[s].value));
  }
  EXPECT_GT(largest, 0.9);  // the machine's range is used
}

TEST_P(ShippedMechanism, WithIdealAmplifiersIsExactToTheTolerance) {
  const mechanism::Mechanism mechanism = shipped(GetParam());
  PatchOptions options;
  options.gain = std::numeric_limits<double>::infinity();
  // What is left is the crank's phase: tolerance 1e-10 accumulated over a turn of some hundred steps.
  EXPECT_LT(largest_error(mechanism, PatchedRun(patch_triangles(mechanism, options)).result),
            1e-7 * mechanism.largest_length());
}

TEST_P(ShippedMechanism, WithAlgebraicAmplifiersErrsByItsGainOnly) {
  const mechanism::Mechanism mechanism = shipped(GetParam());
  PatchOptions options;
  options.gain = 1e4;
  options.bandwidth = std::numeric_limits<double>::infinity();
  const PatchedRun patched(patch_triangles(mechanism, options));
  EXPECT_EQ(patched.program.n_states(), 2U);  // the crank's
  // Static error of a dyad is of the order of reach/(input_gain·μ); three dyads in a row magnify it
  // (method.md).
  EXPECT_LT(largest_error(mechanism, patched.result), 20 / (10 * 1e4) * mechanism.largest_length());
}

TEST_P(ShippedMechanism, WritesADiagramThatReadsBackEqual) {
  const diagram::Diagram diagram = patch_triangles(shipped(GetParam()));
  EXPECT_TRUE(diagram::parse_diagram(diagram::write_diagram(diagram), "patched.toml") == diagram);
}

TEST(Patch, HasACommentedSectionForTheCrankAndEachDyad) {
  const std::string text =
      diagram::write_diagram(patch_triangles(mechanism::parse_mechanism(kFourBar, "four-bar.toml")));
  EXPECT_THAT(text, HasSubstr("# Coordinates: 1 machine unit = 4 m."));
  EXPECT_THAT(text, HasSubstr("# crank AB: turns about A at 1 rad/s"));
  EXPECT_THAT(text, HasSubstr("# dyad BC-CD: C is linked to B (3.5 m) and D (3 m), on the left of B → D."));
  EXPECT_THAT(text, HasSubstr("# B–D is 3 … 5 m long; sin γ at B falls to 0.59."));
  EXPECT_THAT(text, HasSubstr("\"C.x\" = { signal = \"C.x\", scale = 4, unit = \"m\" }"));
}

// The same four-bar, described otherwise: turning backwards, from another angle, the crank's pivot in the
// middle of its points, the other assembly mode.
TEST(Patch, TracksEveryWayToDescribeACrank) {
  const std::string backwards = replaced(kFourBar, "speed = 1", "speed = \"-30 rpm\", start = \"50 deg\"");
  const std::string mirrored = replaced(backwards, "C = [3, 2.8]", "C = [3, -2.8]");
  const std::string lever =
      replaced(replaced(kFourBar, R"(AB = { points = ["A", "B"], length = 1 })",
                        R"(AB = { points = ["E", "B"], length = 1.5, marks = { A = [0.5, 0.2] } })"),
               "turns = \"AB\"", "turns = \"AB\", start = \"10 deg\"");
  for (const std::string& text : {backwards, mirrored, lever}) {
    const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "crank.toml");
    // Error 1.7e-7 of the largest link is measured for the plain four-bar at gain 1e6.
    EXPECT_LT(largest_error(mechanism, PatchedRun(patch_triangles(mechanism)).result),
              1e-6 * mechanism.largest_length())
        << text;
  }
}

TEST(Patch, GivesClashingNamesANumber) {
  std::string text = replaced(kFourBar, "crank = {", "B_x = {");
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "clash.toml");
  const diagram::Diagram diagram = patch_triangles(mechanism);
  EXPECT_LT(largest_error(mechanism, PatchedRun(diagram).result), 1e-6 * mechanism.largest_length());
  EXPECT_THAT(diagram::write_diagram(diagram), HasSubstr("B_x_2"));
}

// The blocks of a dyad and of a crank are called as the joint and the drive.
TEST(Patch, GivesBlocksOtherNamesThanThoseThatExpressionsKeep) {
  for (const std::string name : {"time", "polarity", "in_initial", "in_operate", "in_hold", "pi", "inf",
                                 "and", "or", "not", "one", "if", "sin"}) {
    const std::string quoted = "\"" + name + "\"";
    const std::string joint = replaced(replaced(kFourBar, "\"C\"", quoted), "\"C\"", quoted);
    const mechanism::Mechanism mechanism =
        mechanism::parse_mechanism(replaced(joint, "\nC = ", "\n" + name + " = "), "hinge.toml");
    const diagram::Diagram diagram =
        diagram::parse_diagram(diagram::write_diagram(patch_triangles(mechanism)), "patched.toml");
    EXPECT_LT(largest_error(mechanism, PatchedRun(diagram).result), 1e-6 * mechanism.largest_length())
        << name;
    const mechanism::Mechanism driven =
        mechanism::parse_mechanism(replaced(kFourBar, "crank = {", name + " = {"), "drive.toml");
    EXPECT_NO_THROW(diagram::parse_diagram(diagram::write_diagram(patch_triangles(driven)), "patched.toml"))
        << name;
  }
}

// The same mechanism somewhere else is the same diagram: only the outputs tell where.
TEST(Patch, DoesNotDependOnWhereTheMechanismStands) {
  const mechanism::Mechanism here = mechanism::parse_mechanism(kFourBar, "here.toml");
  const std::string text = replaced(replaced(replaced(kFourBar, "A = [0, 0]", "A = [65536, -131072]"),
                                             "D = [4, 0]", "D = [65540, -131072]"),
                                    "C = [3, 2.8]", "C = [65539, -131069]");
  const mechanism::Mechanism there = mechanism::parse_mechanism(text, "there.toml");
  const diagram::Diagram patched = patch_triangles(there);
  EXPECT_EQ(patched.blocks, patch_triangles(here).blocks);
  const std::string written = diagram::write_diagram(patched);
  EXPECT_THAT(written, HasSubstr("# Coordinates: 1 machine unit = 4 m, from A."));
  EXPECT_THAT(written, HasSubstr("\"C.x\" = { signal = \"C.x\", scale = 4, offset = 65536, unit = \"m\" }"));
  EXPECT_TRUE(diagram::parse_diagram(written, "patched.toml") == patched);
  // as near the origin, and the rounding of the coordinates, 1e-11
  EXPECT_LT(largest_error(there, PatchedRun(patched).result), 1e-6 * there.largest_length());
}

TEST(Patch, RefusesATriangleThatOpensOnTheWay) {
  const mechanism::Mechanism mechanism =
      mechanism::parse_mechanism(replaced(kFourBar, "length = 1 ", "length = 2.7 "), "opens.toml");
  try {
    patch_triangles(mechanism);
    FAIL();
  } catch (const PatchError& error) {
    EXPECT_THAT(error.what(), HasSubstr("opens.toml: the dyad BC-CD cannot be assembled at t = "));
    EXPECT_THAT(error.what(), HasSubstr("remedy: lengthen the links of the dyad, or shorten the crank"));
  }
}

// Crank 1, frame 4, coupler 2, rocker 3: at angle π the distance B–D is 5 = 2 + 3, the triangle is flat.
TEST(Patch, RefusesADeadCentre) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(
      replaced(replaced(kFourBar, "length = 3.5", "length = 2"), "C = [3, 2.8]", "C = [2.5, 2]"),
      "flat.toml");
  try {
    patch_triangles(mechanism);
    FAIL();
  } catch (const PatchError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the dyad BC-CD is at a dead centre at t = 3.14159 s"));
    EXPECT_THAT(error.what(), HasSubstr("expected a group that never comes to a dead centre"));
  }
}

// With a coupler and a rocker of 2.499996 + 2.5 < 5 the triangle opens for 0.18° of the crank, between the
// positions from which the scaling is taken (every half degree, here from 0.25° on).
TEST(Patch, RefusesATriangleThatOpensBetweenItsPositions) {
  std::string text = replaced(kFourBar, "length = 3.5", "length = 2.5");
  text = replaced(text, "length = 3 ", "length = 2.499996 ");
  text = replaced(text, "speed = 1", "speed = 1, start = \"0.25 deg\"");
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "opens.toml");
  EXPECT_THROW(patch_triangles(mechanism), PatchError);
}

TEST(Scaling, RoundsUpToShortNumbers) {
  EXPECT_EQ(round_scale_up(1), 1);
  EXPECT_EQ(round_scale_up(1.01), 2);
  EXPECT_EQ(round_scale_up(330), 400);
  EXPECT_EQ(round_scale_up(0.09), 0.1);
  EXPECT_DOUBLE_EQ(round_up(1.2345), 1.24);
  EXPECT_DOUBLE_EQ(round_up(1.23), 1.23);
  EXPECT_DOUBLE_EQ(round_up(0.071501), 0.0716);
}

// The class III mechanism of the source (AVM class III): two triangles and one outer loop for the triad.
TEST(Patch, TakesATriadApart) {
  const mechanism::Mechanism mechanism =
      mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/class-iii.toml");
  const diagram::Diagram diagram = patch_triangles(mechanism);
  const auto count = [&](const std::string& type) {
    return std::count_if(diagram.blocks.begin(), diagram.blocks.end(),
                         [&](const diagram::BlockInstance& block) { return block.type == type; });
  };
  EXPECT_EQ(count("dyad-rrr-variable"), 1);
  EXPECT_EQ(count("dyad-rrr"), 1);
  EXPECT_EQ(count("servo-amplifier"), 1);
  EXPECT_THAT(diagram::write_diagram(diagram),
              HasSubstr("Of the six splits this one keeps\n# farthest from collinear triangles"));
}

// Of two legs that share their anchor each has its own length.
TEST(LegOf, TellsLegsOfOneAnchorApart) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
O = [0, 0]
O1 = [0, 1.2]
[bodies]
OA = { points = ["O", "A"], length = 0.3 }
AB = { points = ["A", "B"], length = 1.07 }
BDC = { points = ["B", "D"], length = 0.665, marks = { C = [0.825, -0.581] } }
O1D = { points = ["D", "O1"], length = 1.1 }
O1C = { points = ["O1", "C"], length = 1.9 }
[drives]
crank = { turns = "OA", about = "O", speed = 1 }
)",
                                                                    "meet.toml");
  const mechanism::Structure structure = mechanism::find_groups(mechanism);
  const mechanism::Group& triad = structure.groups.at(1);
  ASSERT_EQ(triad.form.kind, mechanism::GroupKind::triad);
  for (std::size_t i = 0; i < 3; ++i) {
    const mechanism::Body& leg = mechanism.bodies[leg_of(triad, i)];
    const double length = (leg.points[1].local - leg.points[0].local).norm();
    EXPECT_DOUBLE_EQ(length, triad.equations.conditions[i].value) << i;
  }
}

/// class-iii.toml and the same once more, 4 to its right, with a P before each name.
mechanism::Mechanism two_triads() {
  std::string frame, bodies, drives, sketch;
  for (const std::string p : {"", "P"}) {
    const double x = p.empty() ? 0 : 4;
    frame += fmt::format("{0}O = [{1}, 0]\n{0}O1 = [{1}, 1.2]\n{0}E = [{2}, 0.824]\n", p, x, x + 1.46);
    bodies += fmt::format(
        "{0}OA = {{ points = [\"{0}O\", \"{0}A\"], length = 0.3 }}\n"
        "{0}AB = {{ points = [\"{0}A\", \"{0}B\"], length = 1.07 }}\n"
        "{0}BDC = {{ points = [\"{0}B\", \"{0}D\"], length = 0.665, "
        "marks = {{ {0}C = [0.825, -0.581] }} }}\n"
        "{0}DE = {{ points = [\"{0}D\", \"{0}E\"], length = 0.757 }}\n"
        "{0}O1C = {{ points = [\"{0}O1\", \"{0}C\"], length = 1.945 }}\n",
        p);
    drives += fmt::format("{0}crank = {{ turns = \"{0}OA\", about = \"{0}O\", speed = 1 }}\n", p);
    sketch += fmt::format("{0}B = [{1}, -0.54]\n{0}D = [{2}, 0.12]\n{0}C = [{3}, 0.33]\n", p, x + 1.22,
                          x + 1.17, x + 1.74);
  }
  return mechanism::parse_mechanism(
      fmt::format("format = \"oblique-mechanism/1\"\n[frame]\n{}[bodies]\n{}[drives]\n{}"
                  "[sketch]\n{}",
                  frame, bodies, drives, sketch),
      "two-triads.toml");
}

// The same split may be asked for, found among those that are stable, or be worth the most.
TEST(Patch, SaysOfEachTriadWhyItHasItsSplit) {
  const std::string best =
      "Of the six splits this one keeps\n# farthest from collinear triangles and from a loop without gain";
  PatchOptions options;
  options.split = {"AB", "DE", "O1C"};
  std::string text = diagram::write_diagram(patch_triangles(two_triads(), options));
  EXPECT_THAT(text, HasSubstr("(split AB, DE, O1C). This split was asked for."));
  EXPECT_THAT(text, HasSubstr("(split PAB, PDE, PO1C). " + best + "."));
  options.split_by_trial = true;
  text = diagram::write_diagram(patch_triangles(two_triads(), options));
  EXPECT_THAT(text, HasSubstr("(split AB, DE, O1C). " + best + ", among those that are stable."));
}

// The split that is named for one triad leaves the other one the source's.
TEST(Patch, NamesASplitOfOneTriadOnly) {
  PatchOptions options;
  options.method = PatchMethod::paper;
  const char* const second = "triad PAB-PBDC-PDE-PO1C, split PAB, PO1C, PDE.";
  EXPECT_THAT(diagram::write_diagram(patch(two_triads(), options)), HasSubstr(second));
  options.split = {"O1C", "DE", "AB"};
  EXPECT_THAT(diagram::write_diagram(patch(two_triads(), options)), HasSubstr(second));
}

TEST(Patch, OffersTheGradientWhereATriadHasASlide) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(
      std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/class-iii-guided.toml");
  try {
    patch_triangles(mechanism);
    FAIL();
  } catch (const PatchError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("has a slide among its legs, so that it cannot be taken apart into triangles"));
    EXPECT_THAT(error.what(), HasSubstr("remedy: patch it with method gradient"));
  }
}

// The way of a prismatic joint's point along a line that moves is scaled by itself, to reach its machine
// unit.
TEST(Patch, UsesTheRangeForTheWayAlongASlot) {
  PatchOptions options;
  options.method = PatchMethod::gradient;
  const PatchedRun patched(patch(shipped("crank-shaper"), options));
  double largest = 0;
  for (std::size_t s = 0; s < patched.result.peaks.size(); ++s) {
    const std::string name = patched.program.signal_names()[s];
    if (name == "slot_dx" || name == "slot_dy")
      largest = std::max(largest, std::abs(patched.result.peaks[s].value));
  }
  EXPECT_GT(largest, 0.9);  // upright, the slot is all dy; the scale is rounded up to two digits
}

// Of a link's points the one that slides matters more than one that nothing else uses.
TEST(Patch, TakesForABodyThePointsThatOthersUse) {
  PatchOptions options;
  options.method = PatchMethod::gradient;
  const std::string text = diagram::write_diagram(patch(mechanism::parse_mechanism(R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
X = [1, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BM = { points = ["B", "M"], length = 2, marks = { S = [3, 0.5] } }
[slides]
guide = { point = "S", along = ["A", "X"] }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
[sketch]
S = [4, 0]
)",
                                                                                   "lever.toml"),
                                                        options));
  EXPECT_THAT(text, HasSubstr("|BS| = 3.04138 m"));  // √(3² + 0.5²)
}

// scotch-yoke-inclined.toml with its guide turned by 30°.
TEST(Patch, DescendsToAYokeOnAnInclinedGuide) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
X = [0.8660254037844387, 0.5]
[bodies]
AB   = { points = ["A", "B"], length = 0.5 }
yoke = { points = ["C", "T"], length = 0.6 }
[slides]
guide = { point = "C", along = ["A", "X"], angle = "60 deg" }
slot  = { point = "B", along = ["C", "T"] }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)",
                                                                    "inclined.toml");
  PatchOptions options;
  options.method = PatchMethod::gradient;
  // It lags by |ẋ|/(K σ²) (method.md): 4e-8 is measured.
  EXPECT_LT(largest_error(mechanism, PatchedRun(patch(mechanism, options)).result), 1e-6);
}

TEST(Patch, RefusesAGradientServoOfInfiniteGain) {
  PatchOptions options;
  options.method = PatchMethod::gradient;
  options.gain = std::numeric_limits<double>::infinity();
  try {
    patch(mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml"),
          options);
    FAIL();
  } catch (const PatchError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a gradient servo of infinite gain or bandwidth has no time scale"));
  }
}

}  // namespace
}  // namespace oblique::patch
