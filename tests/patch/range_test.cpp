// SPDX-License-Identifier: MIT
// Mechanisms that cannot turn, and machine time.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/machine_time.h>
#include <oblique/patch/patch.h>
#include <oblique/patch/range.h>
#include <oblique/solve/run.h>

#include "../support/shipped.h"

namespace oblique::patch {
namespace {

using test::shipped;
using ::testing::HasSubstr;

/// A slide-crank whose slide is driven: between its two dead centres, |x| < 1.5 − 0.5 … 1.5 + 0.5.
const char* const kPump = R"(
format = "oblique-mechanism/1"
[frame]
O = [0, 0]
X = [1, 0]
[bodies]
OA = { points = ["O", "A"], length = 0.5 }
AB = { points = ["A", "B"], length = 1.5 }
[slides]
rod = { point = "B", along = ["O", "X"] }
[drives]
pump = { slides = "rod", speed = 0.3, start = 1.4 }
[sketch]
A = [0.1, 0.5]
)";

/// The first and last value of the first drive over a motion.
std::pair<double, double> span_of(const mechanism::Motion& motion) {
  double least = motion.drives.front().front().value, most = least;
  for (const auto& row : motion.drives) {
    least = std::min(least, row.front().value);
    most = std::max(most, row.front().value);
  }
  return {least, most};
}

TEST(WithinRange, LeavesWhatTurnsAsItIs) {
  for (const char* name : {"four-bar", "jansen", "whitworth", "five-bar"}) {
    const mechanism::Mechanism ranged = within_range(shipped(name));
    EXPECT_FALSE(ranged.drives.front().law) << name;
    EXPECT_FALSE(ranged.motion.until) << name;
  }
}

// The crank of a double rocker: both limits from the law of cosines.
TEST(WithinRange, SwingsOverNineTenthsOfTheRange) {
  const mechanism::Mechanism mechanism = shipped("double-rocker");
  const mechanism::MotionLimits range = mechanism::find_range(mechanism, mechanism::decompose(mechanism));
  ASSERT_TRUE(range.forward && range.backward);
  const mechanism::Drive& drive = mechanism.drives.front();
  const double first = drive.start + drive.speed * range.backward->time;
  const double last = drive.start + drive.speed * range.forward->time;
  const mechanism::Mechanism ranged = within_range(mechanism);
  ASSERT_TRUE(ranged.drives.front().law);
  const mechanism::Motion motion = mechanism::solve_motion(ranged, 1001);
  EXPECT_TRUE(motion.events.empty());
  const auto [least, most] = span_of(motion);
  // a thousand positions find the ends of a sine to 1e-5
  EXPECT_NEAR(most - least, 0.9 * std::abs(last - first), 1e-4 * std::abs(last - first));
  EXPECT_NEAR((most + least) / 2, (first + last) / 2, 1e-4);
  EXPECT_NEAR(motion.drives.front().front().value, drive.start, 1e-12);
  EXPECT_NEAR(motion.drives.back().front().value, drive.start, 1e-9);  // there and back
}

TEST(WithinRange, SwingsADrivenSlideToo) {
  const mechanism::Mechanism ranged = within_range(mechanism::parse_mechanism(kPump, "pump.toml"));
  const mechanism::Motion motion = mechanism::solve_motion(ranged, 1001);
  const auto [least, most] = span_of(motion);
  EXPECT_NEAR(least, 1.5 - 0.45, 1e-4);
  EXPECT_NEAR(most, 1.5 + 0.45, 1e-4);
}

// The start lies at 98 % of the range, where the swing turns round: its law starts with a speed of 0, or of
// what rounding leaves of it, by which no step can be measured.
TEST(WithinRange, MayStartNextToALimit) {
  std::string text = kPump;
  text.replace(text.find("start = 1.4"), 11, "start = 1.99");
  text.replace(text.find("[0.1, 0.5]"), 10, "[0.49, 0.1]");
  const mechanism::Mechanism ranged = within_range(mechanism::parse_mechanism(text, "pump.toml"));
  ASSERT_DOUBLE_EQ(ranged.drives.front().speed, 0.3);
  const mechanism::Motion motion = mechanism::solve_motion(ranged, 1001);
  EXPECT_TRUE(motion.events.empty());
  const auto [least, most] = span_of(motion);
  EXPECT_NEAR(least, 1.01, 1e-4);
  EXPECT_NEAR(most, 1.99, 1e-4);
}

// It sets off the way that the file says, also slowly: 0.3 m/s is less than 1.
TEST(WithinRange, SetsOffAsTheDriveDoes) {
  for (const double way : {1.0, -1.0}) {
    std::string text = kPump;
    if (way < 0) text.replace(text.find("speed = 0.3"), 11, "speed = -0.3");
    const mechanism::Motion motion =
        mechanism::solve_motion(within_range(mechanism::parse_mechanism(text, "pump.toml")), 101);
    EXPECT_NEAR(motion.drives.front().front().value, 1.4, 1e-12);
    EXPECT_GT(way * (motion.drives[1].front().value - 1.4), 0);
  }
}

class Ranged : public ::testing::TestWithParam<PatchMethod> {};
INSTANTIATE_TEST_SUITE_P(Patch, Ranged, ::testing::Values(PatchMethod::triangles, PatchMethod::gradient));

TEST_P(Ranged, IsPatchedOverItsRange) {
  for (const mechanism::Mechanism& mechanism :
       {shipped("double-rocker"), mechanism::parse_mechanism(kPump, "pump.toml")}) {
    PatchOptions options;
    options.method = GetParam();
    const diagram::Diagram diagram = patch(mechanism, options);
    const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
    const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
    const network::Program program(network::assemble(flat));
    const auto result = solve::run(program, flat, solve::options_of(diagram.run));
    const solve::Trajectory& table = result.trajectory;
    const mechanism::Motion exact = mechanism::solve_motion(within_range(mechanism), options.samples);
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      if (mechanism.points[p].fixed) continue;
      const std::size_t x = table.find(mechanism.points[p].name + ".x").value();
      for (std::size_t row = 0; row < table.rows(); ++row) {
        const Eigen::Vector2d place(table.at(row, x), table.at(row, x + 1));
        // 10/μ of the largest link
        EXPECT_LT((place - exact.configurations[row].points[p].position).norm(),
                  1e-5 * mechanism.largest_length());
      }
    }
  }
}

// A period of machine time changes when a point is where, not where it is nor how fast the mechanism's own
// motion is.
TEST(Period, StretchesTimeAndKeepsRates) {
  const mechanism::Mechanism mechanism = shipped("four-bar");
  PatchOptions options;
  options.derivatives = true;
  options.samples = 37;
  const auto table_of = [&](const PatchOptions& how) {
    const diagram::Diagram diagram = patch(mechanism, how);
    const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
    const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
    return solve::run(network::Program(network::assemble(flat)), flat, solve::options_of(diagram.run))
        .trajectory;
  };
  const solve::Trajectory usual = table_of(options);
  options.period = 20;
  const solve::Trajectory stretched = table_of(options);
  // 0.4 m/s and 0.2 m/s² of machine time hold the rates; the mechanism goes 20/2π times as fast
  const diagram::Diagram diagram = patch(mechanism, options);
  EXPECT_THAT(diagram.comment, HasSubstr("Rates: 1 machine unit = 1.27324 m/s and 2.02642 m/s^2."));
  const double faster = 20 / (2 * std::numbers::pi);
  for (const diagram::OutputSpec& output : diagram.outputs) {
    if (output.name == "C.vx") {
      EXPECT_NEAR(output.scale, 0.4 * faster, 1e-12);
    } else if (output.name == "C.ax") {
      EXPECT_NEAR(output.scale, 0.2 * faster * faster, 1e-12);
    }
  }
  ASSERT_EQ(usual.rows(), stretched.rows());
  EXPECT_DOUBLE_EQ(stretched.at(stretched.rows() - 1, 0), 20);
  for (const char* column : {"C.x", "C.y", "M.vx", "M.ay"}) {
    const std::size_t c = usual.find(column).value();
    for (std::size_t row = 0; row < usual.rows(); ++row) {
      // both err by the gain's 1e-6, of rates in units of the crank's 1 rad/s
      EXPECT_NEAR(stretched.at(row, c), usual.at(row, c), 2e-4) << column << row;
    }
  }
}

// Of a drive with a law of its own, and of one that is swung over its range: the same positions, each at its
// part of the twenty seconds.
TEST(Period, StretchesALawWithTheMotion) {
  for (const char* name : {"hydraulic-tipper", "double-rocker"}) {
    const mechanism::Mechanism swung = within_range(shipped(name));
    PatchOptions options;
    options.period = 20;
    const MachineTime time(swung, options);
    EXPECT_NEAR(time.factor, mechanism::period(swung) / 20, 1e-12 * time.factor) << name;
    EXPECT_NEAR(mechanism::period(time.slowed), 20, 1e-9) << name;
    const mechanism::Motion usual = mechanism::solve_motion(swung, 41);
    const mechanism::Motion slowed = mechanism::solve_motion(time.slowed, 41);
    for (std::size_t row = 0; row < usual.drives.size(); ++row) {
      const mechanism::DriveState& fast = usual.drives[row].front();
      const mechanism::DriveState& slow = slowed.drives[row].front();
      EXPECT_NEAR(slow.value, fast.value, 1e-12) << name;
      EXPECT_NEAR(slow.rate, time.factor * fast.rate, 1e-12) << name;
      EXPECT_NEAR(slow.acceleration, time.factor * time.factor * fast.acceleration, 1e-12) << name;
    }
    options.method = PatchMethod::gradient;  // the tipper is no dyads and triads
    EXPECT_NO_THROW(patch(shipped(name), options)) << name;
  }
}

}  // namespace
}  // namespace oblique::patch
