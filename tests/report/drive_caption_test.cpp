// SPDX-License-Identifier: MIT
#include <oblique/report/drive_caption.h>

#include <numbers>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::report {
namespace {

/// A crank of a turn in 2π s that starts where it is told.
std::string caption(const std::string& start, double time, const std::string& speed = "1 rad/s") {
  return drive_caption(
      mechanism::parse_mechanism("format = \"oblique-mechanism/1\"\n[units]\nlength = \"mm\"\n"
                                 "[frame]\nA = [0, 0]\n"
                                 "[bodies]\nAB = { points = [\"A\", \"B\"], length = 1 }\n"
                                 "[drives]\ncrank = { turns = \"AB\", about = \"A\", speed = \"" +
                                     speed + "\", start = \"" + start + "\" }\n",
                                 "m.toml"),
      time);
}

TEST(DriveCaption, GivesDegreesToAFewDigits) {
  EXPECT_EQ(caption("80 deg", 0), "crank = 80°");
  EXPECT_EQ(caption("0 deg", std::numbers::pi / 3), "crank = 60°");
  EXPECT_EQ(caption("10 deg", 1), "crank = 67.2958°");  // 10 + 180/π
}

TEST(DriveCaption, HasATrueMinusAndNoMinusZero) {
  EXPECT_EQ(caption("0 deg", std::numbers::pi / 2, "-1 rad/s"), "crank = −90°");
  EXPECT_EQ(caption("0 deg", 1e-9, "-1 rad/s"), "crank = 0°");
}

}  // namespace
}  // namespace oblique::report
