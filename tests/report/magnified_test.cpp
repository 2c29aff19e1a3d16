// SPDX-License-Identifier: MIT
#include <oblique/report/magnified.h>

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

#include "../support/compiled.h"

namespace oblique::report {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

class Magnified : public ::testing::Test {
 protected:
  MagnifiedAnalog by(double magnification) const {
    return {mechanism_, testing::shipped_blocks(), {}, magnification, timed_, {}, {}};
  }

  /// The largest distance of the overlay from the exact points.
  double largest_shown(const MagnifiedAnalog& analog) const {
    const draw::AnalogOverlay overlay = analog.overlay(timed_);
    double largest = 0;
    for (std::size_t k = 0; k < overlay.motion.size(); ++k) {
      for (std::size_t p = 0; p < overlay.motion[k].size(); ++p) {
        const Eigen::Vector2d& exact = timed_.scene.motion[k].points[p].position;
        largest = std::max(largest, (overlay.motion[k][p] - exact).norm());
      }
    }
    return largest;
  }

  const mechanism::Mechanism mechanism_ =
      mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml");
  const TimedScene timed_ = linkage_scene(mechanism_, 0, 8);
};

TEST_F(Magnified, ErrorsAreShownSoManyTimes) {
  const double error = largest_shown(by(1));
  EXPECT_GT(error, 0);
  EXPECT_NEAR(largest_shown(by(1000)), 1000 * error,
              1e-6 * 1000 * error);  // places of 1 m are rounded to 1e-16
  EXPECT_THAT(by(1000).overlay(timed_).caption, HasSubstr(fmt::format("largest error {:.3g} ", error)));
  EXPECT_EQ(by(1000).overlay(timed_).legend, "analog, error ×1000");
}

// To be seen an error takes 0.002 of the longest link, and beyond twice that link it shows nothing any more;
// 0.05 of it shows it well, and is proposed with one digit, rounded down.
TEST_F(Magnified, TellsWhereTheyAreTooSmallOrTooLarge) {
  const double error = largest_shown(by(1)), size = mechanism_.largest_length();
  const double good = 0.05 * size / error, power = std::pow(10, std::floor(std::log10(good)));
  const std::string proposal =
      fmt::format("magnify {:.0f}e{:.0f} shows it well\n", std::floor(good / power), std::log10(power));
  for (const double seen : {0.0021, 0.05, 1.0, 1.99}) EXPECT_EQ(by(seen * size / error).remark(), "") << seen;
  for (const double seen : {0.0019, 2.01}) {
    const double magnification = std::round(seen * size / error);
    const std::string remark = by(magnification).remark();
    EXPECT_THAT(remark,
                HasSubstr(fmt::format("note: the largest error, {:.3g} {}, is {} at {:.0f} times its size; ",
                                      error, mechanism_.length_unit,
                                      seen < 1 ? "still too small to be seen" : "larger than the mechanism",
                                      magnification)));
    EXPECT_THAT(remark, EndsWith(proposal));
  }
}

// A crank alone, before it moves: cosine 1 and sine 0 are exact.
TEST(MagnifiedAnalog, HasNothingToTellOfNoError) {
  const mechanism::Mechanism crank = mechanism::parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)",
                                                                "crank.toml");
  TimedScene timed;
  timed.scene.shown = mechanism::solve_motion(crank, std::vector<double>{0}).configurations.front();
  const MagnifiedAnalog analog(crank, testing::shipped_blocks(), {}, 10, timed, {}, {});
  EXPECT_EQ((analog.points(0, timed.scene.shown).back() - Eigen::Vector2d(1, 0)).norm(), 0);
  EXPECT_EQ(analog.remark(), "");
}

}  // namespace
}  // namespace oblique::report
