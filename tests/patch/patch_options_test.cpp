// SPDX-License-Identifier: MIT
#include <oblique/patch/patch_options.h>

#include <string>

#include <gtest/gtest.h>

#include "patched_run.h"

namespace oblique::patch {
namespace {

TEST(PatchMethod, IsReadAsItIsNamed) {
  EXPECT_EQ(parse_patch_method("triangles"), PatchMethod::triangles);
  EXPECT_EQ(parse_patch_method("gradient"), PatchMethod::gradient);
  EXPECT_EQ(parse_patch_method("paper"), PatchMethod::paper);
  EXPECT_EQ(method_name(PatchMethod::triangles), "triangles");
  EXPECT_EQ(method_name(PatchMethod::gradient), "gradient");
  EXPECT_EQ(method_name(PatchMethod::paper), "paper");
  EXPECT_FALSE(parse_patch_method("triangle"));
  EXPECT_FALSE(parse_patch_method(""));
}

mechanism::Mechanism turning(const std::string& speed) {
  return mechanism::parse_mechanism(replaced(kFourBar, "speed = 1", "speed = " + speed), "m.toml");
}

// A hundred times the crank's frequency, up to the next 1, 2 or 5: 0.628 rad/s are 0.09995 Hz, and 0.629 are
// 0.10011.
TEST(DefaultBandwidth, IsTheNextStepAboveAHundredTimesTheCrank) {
  EXPECT_EQ(default_bandwidth(turning("0.628")), 10);
  EXPECT_EQ(default_bandwidth(turning("0.629")), 20);
  EXPECT_EQ(default_bandwidth(turning("1.256")), 20);
  EXPECT_EQ(default_bandwidth(turning("1.258")), 50);
  EXPECT_EQ(default_bandwidth(turning("3.141")), 50);
  EXPECT_EQ(default_bandwidth(turning("3.142")), 100);
  EXPECT_EQ(default_bandwidth(turning("-3.142")), 100);
  EXPECT_EQ(default_bandwidth(turning("-100")), 2000);          // 1591
  EXPECT_DOUBLE_EQ(default_bandwidth(turning("1e-4")), 0.002);  // 0.00159
  EXPECT_EQ(default_bandwidth(turning("\"60 rpm\"")), 100);     // 100 exactly
}

// The law is fastest, 1.5 − (−2) = 3.5 rad/s or 55.7 Hz, at 3π/2 and backwards nowhere.
TEST(DefaultBandwidth, IsThatOfTheFastestMomentOfALaw) {
  const std::string until = "[motion]\nuntil = 6\n";
  const auto law = [&](const char* text) {
    return mechanism::parse_mechanism(
        replaced(kFourBar, "speed = 1", std::string("speed = \"") + text + "\"") + until, "m.toml");
  };
  EXPECT_EQ(default_bandwidth(law("1.5 - 2*sin(time) rad/s")), 100);   // 55.7
  EXPECT_EQ(default_bandwidth(law("-1.5 + 2*sin(time) rad/s")), 100);  // the other way round
  EXPECT_EQ(default_bandwidth(law("1 - sin(time) rad/s")), 50);        // 31.8
  EXPECT_EQ(default_bandwidth(law("0.3 - 0.1*sin(time) rad/s")), 10);  // 6.4
  // At the end, and at the start, by as little above 100 as a thousandth of the way makes: 6.286 rad/s.
  EXPECT_EQ(default_bandwidth(law("1.0477*time rad/s")), 200);
  EXPECT_EQ(default_bandwidth(law("6.2863 - time rad/s")), 200);
}

// The ram's 0.1 of a length of 1 at most (QP) are 0.1 rad/s: 1.59 Hz. The crank beside it turns faster.
TEST(DefaultBandwidth, CountsARamByTheLongestLinkAndTakesTheFastestDrive) {
  const std::string ram = R"(
format = "oblique-mechanism/1"
[frame]
O = [0, 0]
W = [-2, 0]
E = [2, 0]
S = [0, 3]
[bodies]
OQ = { points = ["O", "Q"], length = 0.5 }
QP = { points = ["Q", "P"], length = LONGEST }
ST = { points = ["S", "T"], length = 0.2 }
[slides]
guide = { point = "P", along = ["W", "E"] }
[drives]
ram = { slides = "guide", speed = 0.1, start = 3.1 }
crank = { turns = "ST", about = "S", speed = CRANK }
[sketch]
Q = [0.3, 0.4]
)";
  const auto bandwidth = [&](const char* longest, const char* crank) {
    return default_bandwidth(
        mechanism::parse_mechanism(replaced(replaced(ram, "LONGEST", longest), "CRANK", crank), "m.toml"));
  };
  EXPECT_EQ(bandwidth("1", "0.01"), 2);
  EXPECT_EQ(bandwidth("4", "0.01"), 0.5);  // 0.398
  EXPECT_EQ(bandwidth("1", "-5"), 100);    // 79.6
}

TEST(BandwidthOf, IsTheOneAskedForOrThatOfTheMachinesTime) {
  const mechanism::Mechanism four_bar = turning("1");
  PatchOptions options;
  EXPECT_EQ(bandwidth_of(four_bar, options), 20);
  options.period = 2 * 3.14159265358979 * 10;  // ten times as long as the turn
  EXPECT_EQ(bandwidth_of(four_bar, options), 2);
  options.bandwidth = 7;
  EXPECT_EQ(bandwidth_of(four_bar, options), 7);
}

}  // namespace
}  // namespace oblique::patch
