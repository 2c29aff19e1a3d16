// SPDX-License-Identifier: MIT
#include <oblique/compare/compare.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::compare {
namespace {

using std::numbers::pi;
using ::testing::StartsWith;

ComparedRun compared(const std::string& mechanism, patch::PatchMethod method) {
  CompareOptions options;
  options.methods = {method};
  options.gains = {1e3};
  return compare(mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" +
                                           mechanism + ".toml"),
                 diagram::BlockLibrary::shipped(), options)
      .runs.front();
}

// The six-bar's crank of 80 mm lies opposite to D, 200 mm away, at 180°: |BD| = 280 mm is then the longest,
// and with |BC| = 140 mm, |CD| = 150 mm, cos γ = (140² + 280² − 150²)/(2·140·280) = 0.963, sin γ = 0.27.
TEST(WorstReason, IsAFlatTriangle) {
  const ComparedRun run = compared("six-bar", patch::PatchMethod::triangles);
  EXPECT_EQ(run.worst.point, "C");
  EXPECT_NEAR(run.worst.drive, pi, 2 * pi / 360);  // a row
  EXPECT_EQ(run.worst.reason, "the triangle B–C–D is nearest to collinear there (sin γ = 0.27 at B)");
}

// The triangle at fault need not be the point's own: the foot Q5 hangs on Q6.
TEST(WorstReason, IsATriangleThatThePointHangsOn) {
  const ComparedRun run = compared("jansen", patch::PatchMethod::triangles);
  const std::string leg = run.worst.point.substr(0, 1);  // the two are alike, and rounding decides
  EXPECT_EQ(run.worst.point, leg + "5");
  EXPECT_THAT(run.worst.reason, StartsWith("the triangle " + leg + "1–" + leg +
                                           "6–O2 is nearest to collinear there (sin γ = "));
}

TEST(WorstReason, IsAGroupNearADeadCentre) {
  const ComparedRun run = compared("whitworth", patch::PatchMethod::gradient);
  EXPECT_THAT(run.worst.reason,
              StartsWith("the group lever is nearest to a dead centre there (normalised determinant "));
}

// That of the six-bar's dyad is the sine of the angle at C: at 180° cos = (140² + 150² − 280²)/(2·140·150) =
// −0.864, sin = 0.50, whatever the triangle's angle at B.
TEST(WorstReason, OfADyadByGradientIsItsDeterminant) {
  const ComparedRun run = compared("six-bar", patch::PatchMethod::gradient);
  EXPECT_EQ(run.worst.reason,
            "the group BCF-CD is nearest to a dead centre there (normalised determinant 0.5)");
}

// The gains of the four-bar's loops go with |BD| over its longest, 3/5 at 0°; weight 10: L = 10 · 0.6.
TEST(WorstReason, IsALoopOfTheLeastGain) {
  const ComparedRun run = compared("four-bar", patch::PatchMethod::triangles);
  EXPECT_NEAR(std::remainder(run.worst.drive, 2 * pi), 0, 4 * pi / 360);
  EXPECT_THAT(run.worst.reason, StartsWith("the loop of 'C.direction."));
  EXPECT_THAT(run.worst.reason,
              ::testing::EndsWith("has the least gain of all there (6 times the amplifier's)"));
}

// The static error of the centred slider-crank's root is the same all along the turn, so nothing explains
// where rounding puts the largest.
TEST(WorstReason, IsNotMadeUp) {
  EXPECT_EQ(compared("slider-crank", patch::PatchMethod::triangles).worst.reason, "");
}

// The four-bar's group is nearest to a dead centre where it errs most, but hardly nearer than elsewhere.
TEST(WorstReason, IsNotWhatHardlyChanges) {
  EXPECT_EQ(compared("four-bar", patch::PatchMethod::gradient).worst.reason, "");
}

}  // namespace
}  // namespace oblique::compare
