// SPDX-License-Identifier: MIT
// Velocities and accelerations as circuits, held against solve's closed forms.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>

#include "../support/rate_errors.h"
#include "patched_run.h"

namespace oblique::patch {
namespace {

using ::testing::HasSubstr;

const char* const kFourBar = R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5, marks = { M = [1.5, 1] } }
CD = { points = ["C", "D"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
[sketch]
C = [3, 2.8]
)";

PatchOptions with_rates(PatchMethod method = PatchMethod::triangles, double gain = 1e6) {
  PatchOptions options;
  options.method = method;
  options.gain = gain;
  options.derivatives = true;
  return options;
}

test::RateErrors errors_of(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  return test::rate_errors(mechanism, PatchedRun(patch(mechanism, options)).result.trajectory);
}

class Rates : public ::testing::TestWithParam<PatchMethod> {};
INSTANTIATE_TEST_SUITE_P(Patch, Rates, ::testing::Values(PatchMethod::triangles, PatchMethod::gradient),
                         [](const auto& tested) { return std::string(method_name(tested.param)); });

// A servo's static error and its lag both fall as 1/μ, in the positions that feed it as in the rates
// themselves.
TEST_P(Rates, ConvergeWithTheGain) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(kFourBar, "four-bar.toml");
  test::RateErrors before;
  for (const double gain : {1e3, 1e4, 1e5}) {
    const test::RateErrors errors = errors_of(mechanism, with_rates(GetParam(), gain));
    EXPECT_LT(errors.velocity, 1 / gain);  // 0.33/μ and 0.39/μ are measured
    EXPECT_LT(errors.acceleration, 1 / gain);
    if (before.velocity > 0) {
      EXPECT_NEAR(std::log10(errors.velocity / before.velocity), -1, 0.02) << gain;
      EXPECT_NEAR(std::log10(errors.acceleration / before.acceleration), -1, 0.02) << gain;
    }
    before = errors;
  }
}

// Between the half degrees from which the scaling is taken a signal rises by (π/720)²/2 = 1e-5 of itself at
// most, and the margin of the forms is a hundred times that.
TEST_P(Rates, KeepEverySignalWithinOneMachineUnit) {
  for (const char* const name : {"four-bar", "slider-crank-offset", "oldham", "class-iii"}) {
    const PatchedRun patched(patch(shipped(name), with_rates(GetParam())));
    for (std::size_t s = 0; s < patched.result.peaks.size(); ++s) {
      EXPECT_LE(std::abs(patched.result.peaks[s].value), 1 + 1e-6)
          << name << " " << patched.program.signal_names()[s];
    }
  }
}

// The same four-bar described otherwise: turning backwards, from another angle, the crank's pivot in the
// middle of its points, the other assembly mode.
TEST_P(Rates, FollowEveryWayToDescribeACrank) {
  const std::string backwards = replaced(kFourBar, "speed = 1", "speed = \"-30 rpm\", start = \"50 deg\"");
  const std::string mirrored = replaced(backwards, "C = [3, 2.8]", "C = [3, -2.8]");
  const std::string lever =
      replaced(kFourBar, R"(AB = { points = ["A", "B"], length = 1 })",
               R"(AB = { points = ["E", "B"], length = 1.5, marks = { A = [0.5, 0.2] } })");
  for (const std::string& text : {backwards, mirrored, lever}) {
    const test::RateErrors errors =
        errors_of(mechanism::parse_mechanism(text, "crank.toml"), with_rates(GetParam()));
    EXPECT_LT(errors.velocity, 1e-6) << text;
    EXPECT_LT(errors.acceleration, 1e-6) << text;
  }
}

// A crank on the coupler of a four-bar, whose pivot moves; its drive gives its angle against the frame.
TEST_P(Rates, FollowACrankOnAMovingPivot) {
  std::string text = replaced(kFourBar, "[drives]\n",
                              "ME = { points = [\"M\", \"E\"], length = 0.5 }\n[drives]\n"
                              "second = { turns = \"ME\", about = \"M\", speed = -2 }\n");
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "on-coupler.toml");
  const test::RateErrors errors = errors_of(mechanism, with_rates(GetParam()));
  EXPECT_LT(errors.velocity, 1e-6);
  EXPECT_LT(errors.acceleration, 1e-6);
}

// A drive's own acceleration enters too: φ̈ = −3 sin 3t [rad/s²] for a crank, and for a prismatic joint.
TEST_P(Rates, FollowASpeedLaw) {
  const std::string law =
      replaced(kFourBar, "speed = 1", "speed = \"0.2 + cos(3*time) rad/s\"") + "[motion]\nuntil = 4\n";
  for (const mechanism::Mechanism& mechanism :
       {mechanism::parse_mechanism(law, "law.toml"), shipped("elliptical-trammel-by-slide")}) {
    const PatchedRun patched(patch(mechanism, with_rates(GetParam())));
    const test::RateErrors errors = test::rate_errors(mechanism, patched.result.trajectory);
    EXPECT_LT(errors.position, 1e-6) << mechanism.title;
    EXPECT_LT(errors.velocity, 1e-6) << mechanism.title;
    EXPECT_LT(errors.acceleration, 1e-6) << mechanism.title;
    for (std::size_t s = 0; s < patched.result.peaks.size(); ++s) {
      EXPECT_LE(std::abs(patched.result.peaks[s].value), 1 + 1e-6) << patched.program.signal_names()[s];
    }
  }
}

// The source has no rates; they hang on the places of its points as on those of any other patch.
TEST(RateCircuits, HangOnThePatchOfTheSource) {
  PatchOptions options = with_rates(PatchMethod::paper, 1e5);
  options.slower = 1000;  // with the source's split the outer loop has to be
  const test::RateErrors errors = errors_of(shipped("class-iii"), options);
  EXPECT_LT(errors.velocity, 1e-3);  // 10/μ and more: one scale for all lengths costs gain
  EXPECT_LT(errors.acceleration, 1e-3);
}

TEST(RateCircuits, WithIdealAmplifiersAreExactToTheTolerance) {
  PatchOptions options = with_rates(PatchMethod::triangles, std::numeric_limits<double>::infinity());
  for (const char* const name : {"four-bar", "six-bar", "class-iii"}) {
    const test::RateErrors errors = errors_of(shipped(name), options);
    // the crank's phase: tolerance 1e-10 accumulated over some hundred steps
    EXPECT_LT(errors.velocity, 1e-7) << name;
    EXPECT_LT(errors.acceleration, 1e-7) << name;
  }
}

TEST(RateCircuits, AreAlgebraicWithAmplifiersOfInfiniteBandwidth) {
  PatchOptions options = with_rates(PatchMethod::triangles, 1e4);
  options.bandwidth = std::numeric_limits<double>::infinity();
  const PatchedRun patched(patch(shipped("six-bar"), options));
  EXPECT_EQ(patched.program.n_states(), 2U);  // the crank's
  const test::RateErrors errors = test::rate_errors(shipped("six-bar"), patched.result.trajectory);
  EXPECT_LT(errors.velocity, 2e-4);  // 0.7/μ and 1.6/μ are measured with a bandwidth
  EXPECT_LT(errors.acceleration, 4e-4);
}

TEST(RateCircuits, CallTheirOutputsAsSolveCallsItsColumns) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(kFourBar, "four-bar.toml");
  const diagram::Diagram diagram = patch(mechanism, with_rates());
  std::vector<std::pair<std::string, std::string>> outputs, columns;
  for (const diagram::OutputSpec& output : diagram.outputs) outputs.emplace_back(output.name, output.unit);
  for (const mechanism::MotionColumnName& column : mechanism::motion_column_names(mechanism)) {
    const std::string point = column.name.substr(0, column.name.find('.'));
    if (mechanism.find_point(point)) columns.emplace_back(column.name, column.unit);
  }
  EXPECT_EQ(outputs, columns);
}

TEST(RateCircuits, StandInTheFileWithTheirScale) {
  const diagram::Diagram diagram = patch(mechanism::parse_mechanism(kFourBar, "four-bar.toml"), with_rates());
  const std::string text = diagram::write_diagram(diagram);
  EXPECT_TRUE(diagram::parse_diagram(text, "patched.toml") == diagram);
  EXPECT_THAT(text, HasSubstr("# Rates: 1 machine unit = 2 m/s and 2 m/s^2."));
  EXPECT_THAT(text, HasSubstr("# rates of the group BC-CD: its conditions, differentiated once and twice"));
  EXPECT_THAT(text, HasSubstr("\"C.vx\" = { signal = \"C_vx\", scale = 2, unit = \"m/s\" }"));
}

// A law that is zero for ten seconds: nothing moves by which a rate could be measured, and its unit is 1.
TEST(RateCircuits, OfWhatStandsStillHaveTheUnitOne) {
  std::string text = kFourBar;
  text.replace(text.find("speed = 1"), 9, "speed = \"0*time rad/s\"");
  PatchOptions options = with_rates();
  options.bandwidth = 1000;
  const diagram::Diagram diagram =
      patch(mechanism::parse_mechanism(text + "[motion]\nuntil = 10\n", "still.toml"), options);
  EXPECT_THAT(diagram.comment, HasSubstr("Rates: 1 machine unit = 1 m/s and 1 m/s^2."));
}

}  // namespace
}  // namespace oblique::patch
