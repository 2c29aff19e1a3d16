// SPDX-License-Identifier: MIT
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/patch/patch.h>

#include "patched_run.h"

namespace oblique::patch {
namespace {

using ::testing::HasSubstr;

// Slow at the start and the end, backwards in between, and at a standstill twice: the exact motion has the
// law's integral.
TEST(Patch, FollowsASpeedLaw) {
  const std::string text =
      replaced(kFourBar, "speed = 1", "speed = \"0.2 + cos(3*time)*30 rpm\"") + "[motion]\nuntil = 4\n";
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "law.toml");
  const diagram::Diagram diagram = patch_triangles(mechanism);
  EXPECT_EQ(diagram.run.until, 4);
  EXPECT_LT(largest_error(mechanism, PatchedRun(diagram).result), 1e-6 * mechanism.largest_length());
  const std::string written = diagram::write_diagram(diagram);
  EXPECT_THAT(written, HasSubstr("Run over the 4 s of its motion."));
  EXPECT_THAT(written, HasSubstr("# crank AB: turns about A at (0.2 + cos(3*time)*30)*0.10472 rad/s"));
  EXPECT_TRUE(diagram::parse_diagram(written, "patched.toml") == diagram);
}

TEST(Patch, FollowsALawThatStartsFromRest) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(
      replaced(kFourBar, "speed = 1", "speed = \"sin(time/4)^2 rad/s\""), "law.toml");
  const diagram::Diagram diagram = patch_triangles(mechanism);
  EXPECT_NEAR(diagram.run.until, mechanism::period(mechanism), 1e-12);  // a whole turn
  EXPECT_LT(largest_error(mechanism, PatchedRun(diagram).result), 1e-6 * mechanism.largest_length());
}

// roberts.toml swings by 17° · 2π cos 2πt: 1.86 rad/s at most.
TEST(Patch, ChoosesTheBandwidthOfALawByItsGreatestSpeed) {
  EXPECT_EQ(default_bandwidth(shipped("roberts")), 50);
  const std::string from_rest = replaced(kFourBar, "speed = 1", "speed = \"10*sin(time) rad/s\"");
  EXPECT_EQ(default_bandwidth(mechanism::parse_mechanism(from_rest, "m.toml")), 200);  // 1000/(2π) = 159
}

/// A slider-crank that its slider drives; the slider's way counts from W, farther off than any coordinate.
const char* const kDrivenSlider = R"(
format = "oblique-mechanism/1"
[frame]
O = [0, 0]
W = [-2, 0]
E = [2, 0]
[bodies]
OQ = { points = ["O", "Q"], length = 0.5 }
QP = { points = ["Q", "P"], length = 1 }
[slides]
guide = { point = "P", along = ["W", "E"] }
[drives]
ram = { slides = "guide", speed = 0.1, start = 3.1 }
[motion]
until = 2
[sketch]
Q = [0.3, 0.4]
)";

// The exact way ends at 3.3, and swings up to 3.1 + 0.2·sin(1.57…): where that lies between two rows of the
// motion, the scale has room for it.
TEST(Drives, OfASlideStayWithinOneMachineUnit) {
  for (const std::string speed : {"0.1", "\"0.2*cos(time)\""}) {
    const mechanism::Mechanism mechanism =
        mechanism::parse_mechanism(replaced(kDrivenSlider, "speed = 0.1", "speed = " + speed), "ram.toml");
    for (const PatchMethod method : {PatchMethod::triangles, PatchMethod::gradient}) {
      PatchOptions options;
      options.method = method;
      options.samples = 8;
      const PatchedRun patched(patch(mechanism, options));
      bool is_there = false;
      for (std::size_t s = 0; s < patched.result.peaks.size(); ++s) {
        if (patched.program.signal_names()[s] != "ram") continue;
        is_there = true;
        EXPECT_LE(std::abs(patched.result.peaks[s].value), 1 + 1e-12);  // rounding
        EXPECT_GT(std::abs(patched.result.peaks[s].value), 0.98);       // rounded up to three digits
      }
      EXPECT_TRUE(is_there);
      EXPECT_LT(largest_error(mechanism, patched.result), 1e-5);  // of gain 1e6
    }
  }
}

}  // namespace
}  // namespace oblique::patch
