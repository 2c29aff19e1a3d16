// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/drive_law.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/text/expression_parser.h>

namespace oblique::mechanism {
namespace {

// A speed w/(w² + (t − c)²) gives the way atan((t − c)/w) + atan(c/w). Its peak of w = 0.5 ms needs intervals
// of about that width, whichever end of a second it stands at, or within it.
TEST(DriveClock, FollowsAPeakWhereverItStands) {
  constexpr double kWidth = 5e-4;
  for (const double centre : {-1.0, -0.7, 0.0, 0.3, 1.0, 1.6}) {
    Mechanism mechanism;
    Drive drive;
    drive.law = text::parse_expression(fmt::format("{0}/({0}^2 + (time - ({1}))^2)", kWidth, centre));
    drive.start = 2;
    drive.law_scale = 3;
    mechanism.drives.push_back(drive);
    DriveClock clock(mechanism);
    for (const double t : {2.0, -2.0, 0.4, -0.4, 1.0, -1.0, 1.7}) {
      const double way = 3 * (std::atan((t - centre) / kWidth) + std::atan(centre / kWidth));
      // a ten-millionth of the way is a thousand times the 1e-9 that the rules are to agree to
      EXPECT_NEAR(clock.at(0, t).value, 2 + way, 1e-7) << centre << " at " << t;
    }
  }
}

// The same way in another unit of time, of a motion that takes years: its intervals are as long.
TEST(DriveClock, TakesNoLongerForASlowMotion) {
  for (const double slow : {1.0, 1e4, 1e9, 1e15}) {
    Mechanism mechanism;
    Drive drive;
    drive.law = text::parse_expression(fmt::format("cos(time/{:.17g})", slow));
    drive.law_scale = 1 / slow;
    mechanism.drives.push_back(drive);
    mechanism.motion.until = 100 * slow;
    DriveClock clock(mechanism);
    for (const double part : {1.0, 99.0, -20.0, 40.0})
      EXPECT_NEAR(clock.at(0, part * slow).value, std::sin(part), 1e-9);
  }
}

// What no point of a rule sees of a second: a pulse of a tenth of a millisecond, alone and on a constant
// speed. By the error function it is √π h w (erf((t − c)/w) + erf(c/w))/2 of the way; whichever moment is
// asked first.
TEST(DriveClock, PassesNoShortPulseOver) {
  constexpr double kWidth = 1e-4, kHeight = 300, kCentre = 1.2345;
  for (const double speed : {0.0, 1.0}) {
    for (const std::vector<double>& times :
         {std::vector{4.0, 1.2, 1.3}, std::vector{1.3, 4.0, 1.2}, std::vector{1.2345, 2.0}}) {
      Mechanism mechanism;
      Drive drive;
      drive.law = text::parse_expression(
          fmt::format("{} + {} * exp(-((time - {})/{})^2)", speed, kHeight, kCentre, kWidth));
      drive.law_scale = 1;
      mechanism.drives.push_back(drive);
      DriveClock clock(mechanism);
      for (const double t : times) {
        const double pulse = std::sqrt(std::numbers::pi) * kHeight * kWidth *
                             (std::erf((t - kCentre) / kWidth) + std::erf(kCentre / kWidth)) / 2;
        // each piece errs by about 1e-18 of itself, and by 1e-6 of the speed where bounds leave no more
        EXPECT_NEAR(clock.at(0, t).value, speed * t + pulse, 1e-9) << speed << " at " << t;
      }
    }
  }
}

// A speed that all but jumps, 1 + atan((t − 0.7)/w)/2, as far as its integral tells.
TEST(DriveClock, FollowsAnAllButSuddenChangeOfSpeed) {
  constexpr double kWidth = 1e-6, kCentre = 0.7;
  Mechanism mechanism;
  Drive drive;
  drive.law = text::parse_expression("1 + 0.5 * atan(1e6 * (time - 0.7))");
  drive.law_scale = 1;
  mechanism.drives.push_back(drive);
  const auto integral = [](double t) {
    const double u = (t - kCentre) / kWidth;
    return t + kWidth * (u * std::atan(u) - std::log1p(u * u) / 2) / 2;
  };
  DriveClock clock(mechanism);
  for (const double t : {2.0, 0.5, 0.7, 0.7001})
    EXPECT_NEAR(clock.at(0, t).value, integral(t) - integral(0), 1e-10) << t;
}

}  // namespace
}  // namespace oblique::mechanism
