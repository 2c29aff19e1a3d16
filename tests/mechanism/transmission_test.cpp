// SPDX-License-Identifier: MIT
#include <oblique/mechanism/analysis/transmission.h>

#include <vector>

#include <fmt/format.h>
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

// A slotted lever: by Hadamard's inequality at most 1, and where the slot lies a hundredth of the frame
// beside the lever's line it is about what it is where it lies on it. (The offset was the unit of the lever's
// turn.)
TEST(TransmissionSignal, OfASlottedLeverIsAtMostOne) {
  const auto values_of = [](double offset) {
    const Mechanism lever = mechanism(fmt::format(R"(
[frame]
A = [0, 0]
D = [0.15, 0]
[bodies]
AB = {{ points = ["A", "B"], length = 0.1 }}
BP = {{ points = ["B", "P"], length = 0.3 }}
[slides]
b = {{ point = "D", along = ["B", "P"], offset = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1 }}
[sketch]
P = [0.4, 0]
)",
                                                  offset));
    const Structure structure = decompose(lever);
    const MotionRange range = plan_motion_range(lever, structure);
    RangeWalk walk(lever, structure, range);
    const Signal signal = transmission_signal(structure, structure.groups.size() - 1);
    std::vector<double> values;
    for (const double u : {0.05, 0.3, 0.5, 0.8}) {
      walk.go(u);
      values.push_back(signal.at(walk).value);
    }
    return values;
  };
  const std::vector<double> straight = values_of(0);
  for (const double offset : {1e-4, 1e-3, 0.01}) {
    const std::vector<double> values = values_of(offset);
    for (std::size_t k = 0; k < values.size(); ++k) {
      EXPECT_LE(values[k], 1) << offset;
      EXPECT_NEAR(values[k], straight[k], offset)
          << offset;  // it changes by the part that the offset is of the lever
    }
  }
}

}  // namespace
}  // namespace oblique::mechanism
