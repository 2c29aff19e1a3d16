// SPDX-License-Identifier: MIT
#include <oblique/mechanism/analysis/transmission.h>

#include <gtest/gtest.h>

#include "analysed.h"

namespace oblique::mechanism {
namespace {

using namespace analysed;

// The derivative of the angle by time, by differences: they err by the square of the step, and by 1e-16 over
// it.
void expect_rates(const Mechanism& tested) {
  const Structure structure = decompose(tested);
  const MotionRange range = plan_motion_range(tested, structure);
  RangeWalk walk(tested, structure, range);
  const Signal signal = transmission_signal(structure, structure.groups.size() - 1);
  ASSERT_TRUE(signal.has_rate);
  constexpr double kStep = 1e-5;
  const auto at = [&](double u) {
    walk.go(u);
    return signal.at(walk);
  };
  for (const double u : {0.07, 0.23, 0.41, 0.68, 0.9}) {
    const double difference = (at(u + kStep).value - at(u - kStep).value) / (2 * kStep) / range.rate(u);
    EXPECT_NEAR(at(u).rate, difference, 1e-7) << u;
  }
}

TEST(TransmissionSignal, HasTheRateOfItsAngle) {
  expect_rates(four_bar(1, 3.5, 3, 4, "17 deg"));
  expect_rates(four_bar(1, 3.5, 3, 4, "17 deg", "[3, -3]"));
  expect_rates(slider_crank(40));
}

}  // namespace
}  // namespace oblique::mechanism
