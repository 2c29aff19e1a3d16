// SPDX-License-Identifier: MIT
// Switches of a run that is saved and gone on with: what the errors of the states do not tell from zero stays
// where it was, and what slid goes on sliding.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/solve/run_state.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The run of a diagram, and that of its second half from what the first half saved as a text.
struct Halves {
  Halves(const testing::Compiled& made, double until, double tolerance) {
    RunOptions options;
    options.until = until;
    options.tolerance = tolerance;
    options.samples = 101;
    whole = oblique::solve::run(made.program, made.flat, options);
    options.until = until / 2;
    options.samples = 51;
    first = oblique::solve::run(made.program, made.flat, options);
    options.from = parse_run_state(to_text(first.state), "state.toml");
    options.until = until;
    second = oblique::solve::run(made.program, made.flat, options);
  }
  Run whole, first, second;
};

/// What a run saves, with another value of one of its states.
auto saved_with(const testing::Compiled& made, const RunOptions& options, const std::string& state,
                const std::string& value) {
  std::string text = to_text(oblique::solve::run(made.program, made.flat, options).state);
  const std::size_t at = text.find("\"" + state + "\" = ");
  EXPECT_NE(at, std::string::npos);
  text.replace(at, text.find('\n', at) - at, "\"" + state + "\" = " + value);
  return parse_run_state(text, "state.toml");
}

// x = 0.9 e^(−5.8 t): half way it is 3e-10, at the end 1e-19, and its sign is always the same.
TEST(ResumedSwitch, OfADecayStaysWhereItWas) {
  const testing::Compiled made(R"(
x = { type = "transfer-lag", in = "0*x", time_constant = 0.1724, initial = -0.9 }
s = { type = "sign", in = "x" }
)");
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    for (const double until : {3.0, 5.0, 7.5, 11.0}) {
      const Halves halves(made, until, tolerance);
      for (const oblique::solve::Run* const run : {&halves.whole, &halves.second}) {
        EXPECT_THAT(testing::row_values(*run, "s"), ::testing::Each(-1)) << tolerance << ' ' << until;
        EXPECT_EQ(run->event_count, 0) << tolerance << ' ' << until;
        EXPECT_THAT(run->warnings, IsEmpty());
      }
    }
  }
}

// A solver of stiff equations may leave a decay on the other side of zero, by less than its error when that
// was larger: it goes on decaying there, through whatever else happens.
TEST(ResumedSwitch, OfADecayMayLieOnTheOtherSide) {
  const testing::Compiled made(R"(
x = { type = "transfer-lag", in = "-2*x", time_constant = 0.09375, initial = 0.375 }
s = { type = "sign", in = "x" }
clock = { type = "pulse-train", period = 0.1, width = 0.05 }
)");
  RunOptions options;
  options.until = 0.91;
  options.tolerance = 1e-6;
  options.from = saved_with(made, options, "x", "-1.9e-10");
  options.until = 1.8;
  options.method = diagram::IntegrationMethod::bdf;
  const oblique::solve::Run run = oblique::solve::run(made.program, made.flat, options);
  EXPECT_THAT(testing::row_values(run, "s"), ::testing::Each(1));
}

// A relay servo with rate feedback, z′ = v, 0.35 v′ = −v − 1.5 sgn(z + 0.55 v), slides from t = 0.3166193 on,
// with z′ = −z/0.55; it is saved 0.1 µs before, where the comparison lies within its errors.
TEST(ResumedSwitch, SlidesThatBeginWithinTheErrorsDoSo) {
  const testing::Compiled made(R"(
z = { type = "integrator", in = ["v"], initial = 0.7173 }
d = { type = "comparator", in = ["z", "0.55*v"], low = -1, high = 1 }
u = { type = "gain", in = "d", factor = -1.5 }
v = { type = "transfer-lag", in = "u", time_constant = 0.35, initial = -0.148 }
)");
  RunOptions options;
  options.until = 0.3166192;
  options.tolerance = 1e-6;
  options.from =
      parse_run_state(to_text(oblique::solve::run(made.program, made.flat, options).state), "s.toml");
  options.until = 3;
  const oblique::solve::Run run = oblique::solve::run(made.program, made.flat, options);
  const double begin = testing::row_values(run, "z").front();
  // Ten tolerances; from zero on z would be off by more were it left to chatter.
  EXPECT_NEAR(testing::row_values(run, "z").back(), begin * std::exp(-(3 - 0.3166193) / 0.55), 1e-5);
  EXPECT_EQ(run.event_count, 2);
}

// A lag of 10 ns behind a sine differs from it by −1e-8 cos t, which is positive from 5π/2 on. 0.1 µs before,
// the state that is saved is off by more than that: what begins with it turns the comparator over when the
// difference is 30 times as large, a half of a second late, and says so.
TEST(ResumedSwitch, ThatTurnsOverLateByWhatTheSavedStateIsOffIsToldOf) {
  const testing::Compiled made(R"toml(
x = { type = "sine-source", frequency = "1/(2*pi)" }
l = { type = "transfer-lag", in = "x", time_constant = 1e-8 }
c = { type = "comparator", in = ["-x", "l"] }
)toml");
  RunOptions options;
  options.until = 7.8539815;
  options.tolerance = 1e-8;
  options.from = saved_with(made, options, "l", "1.0000000002");
  options.until = 12;
  const oblique::solve::Run run = oblique::solve::run(made.program, made.flat, options);
  ASSERT_EQ(run.warnings.size(), 1U);
  EXPECT_THAT(run.warnings.front().what, ::testing::StartsWith("'c' (in > 0) does not hold from t = 7.854"));
  EXPECT_THAT(run.warnings.front().what, HasSubstr("so that it may be late"));
}

// x′ = 0.5 − sgn x slides along zero from t = 2/3 on.
const char* const kSlide = R"(
half = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["half", "-s"], initial = 0.3333333333333333 }
s = { type = "sign", in = "x" }
)";

// The mean of the sign is 0.5, to the tolerance.
TEST(ResumedSwitch, ThatSlidGoesOnSliding) {
  const testing::Compiled made(kSlide);
  const Halves halves(made, 4, 1e-8);
  EXPECT_THAT(halves.first.state.sliding, ::testing::Contains(true));
  EXPECT_THAT(halves.second.warnings, IsEmpty());
  for (const double s : testing::row_values(halves.second, "s")) EXPECT_NEAR(s, 0.5, 1e-8);
  for (const double x : testing::row_values(halves.second, "x")) EXPECT_NEAR(x, 0, 1e-7);
  EXPECT_EQ(halves.second.event_count, 1) << "that it slides, at its start";
}

// x is 0 and s therefore −1, also when i, which it drives to its limit, slides along that: nothing asks s to
// turn over where another switch does, though i could leave its limit then.
TEST(ResumedSwitch, AtRestStaysWhereItWasBesideASlide) {
  const testing::Compiled made(R"(
x = { type = "transfer-lag", in = "0*x", time_constant = 1 }
s = { type = "sign", in = "2*x" }
i = { type = "integrator", in = ["-1.7*s", "-0.5*i"], limit = 1.2, gain = 1e4, bandwidth = 1e4 }
wave = { type = "sine-source", frequency = 0.3 }
c = { type = "comparator", in = ["wave"], hysteresis = 0.1 }
)");
  const Halves halves(made, 3, 1e-7);
  EXPECT_THAT(halves.first.state.sliding, ::testing::Contains(true));
  EXPECT_THAT(testing::row_values(halves.second, "s"), ::testing::Each(-1));
  // The limit is that of the capacitor: the output is less by one part in the gain; a slide may drift by
  // 1e-7.
  for (const double i : testing::row_values(halves.second, "i")) EXPECT_NEAR(i, 1.2 / (1 + 1e-4), 2e-7);
}

// Of a run that goes on with a slide nothing is too small, and none of it is run finer.
TEST(ResumedSwitch, ThatSlidIsKnown) {
  const testing::Compiled made(kSlide);
  for (const double until : {1.8, 2.7, 5.0, 7.4, 14.2}) {
    const Halves halves(made, until, 1e-8);
    EXPECT_THAT(halves.second.warnings, IsEmpty()) << until;
    EXPECT_LT(halves.second.statistics.steps, 1000) << until;
  }
}

// A state that was saved before it said what slides goes on, too: all that lies at zero may have slid.
TEST(ResumedSwitch, OfAStateThatDoesNotSayWhatSlid) {
  const testing::Compiled made(kSlide);
  const Halves halves(made, 4, 1e-8);
  std::string text = to_text(halves.first.state);
  const std::size_t at = text.find("sliding = ");
  ASSERT_NE(at, std::string::npos);
  text.erase(at, text.find('\n', at) + 1 - at);
  RunOptions options;
  options.from = parse_run_state(text, "state.toml");
  options.until = 4;
  const oblique::solve::Run run = oblique::solve::run(made.program, made.flat, options);
  for (const double s : testing::row_values(run, "s")) EXPECT_NEAR(s, 0.5, 1e-8);
}

TEST(ResumedSwitch, OfAnotherDiagramIsRefused) {
  const testing::Compiled made(
      "x = { type = \"integrator\", in = \"-s\", initial = 1 }\n"
      "s = { type = \"sign\", in = \"x\" }\n");
  RunState state = Halves(made, 1, 1e-8).first.state;
  state.sliding.push_back(false);
  RunOptions options;
  options.from = state;
  try {
    oblique::solve::run(made.program, made.flat, options);
    FAIL() << "went on";
  } catch (const text::ReadError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("this is the state of another diagram: it has 2 switches, the diagram "
                          "1; expected the state of a run of this diagram"));
  }
}

// x′ = 0.5 − sgn x slides until the machine is held, and then stands where the comparison was: within its
// errors of zero, where a real one would have no certain output either. That is told, where anybody sees it.
TEST(HeldSlide, IsToldOf) {
  const std::string loop =
      "half = { type = \"constant\", value = 0.5 }\n"
      "x = { type = \"integrator\", in = [\"half\", \"-s\"], initial = 0.1 }\n"
      "s = { type = \"sign\", in = \"x\" }\n";
  const std::string held =
      "[timeline]\nphases = [{ mode = \"operate\", for = 0.5 }, { mode = \"hold\", for = 0.5 }]\n";
  const oblique::solve::Run run = testing::run_of(testing::Compiled(loop, held));
  ASSERT_EQ(run.warnings.size(), 1U);
  EXPECT_EQ(
      text::to_string(run.warnings.front()),
      "d.toml: 's' (in > 0) stops on the switching surface that it slid along at t = 0.5 s, where nothing "
      "moves it "
      "any more: rounding decides on which side it stays\n  remedy: give the comparison a hysteresis, or "
      "do not read it while it rests");
  const oblique::solve::Run smooth =
      testing::run_of(testing::Compiled("x = { type = \"integrator\", in = \"-m\", initial = 0.1 }\nm = { "
                                        "type = \"absolute-value\", in = \"x\" }\n",
                                        held));
  EXPECT_THAT(smooth.warnings, IsEmpty());
}

// At zero neither `in > 0` nor `0 > in` holds, in whatever order the blocks stand: of two points of one x
// the second holds.
TEST(SwitchAtZero, HoldsNeitherWay) {
  const std::string magnitude = "a = { type = \"absolute-value\", in = \"x\" }\n";
  const std::string jump =
      "f = { type = \"function-generator\", in = \"x\", points = [[-1, 0.5], [0, 0], [0, 1], [1, 1]] }\n";
  const std::string rest = "x = { type = \"integrator\", in = \"0*x\" }\n";
  for (const std::string& blocks :
       {magnitude + jump + rest, jump + magnitude + rest, rest + jump + magnitude}) {
    const oblique::solve::Run run = testing::run_of(testing::Compiled(blocks));
    EXPECT_THAT(testing::row_values(run, "f"), ::testing::Each(1)) << blocks;
  }
}

// Nor do they where something else goes by them.
TEST(SwitchAtZero, HoldsNeitherWayWhereIntegratorsReadIt) {
  const std::string rest = "x = { type = \"integrator\", in = \"0*x\" }\n";
  const std::string above = "a = { type = \"comparator\", in = \"x\" }\n";
  const std::string below = "b = { type = \"comparator\", in = \"-x\" }\n";
  const std::string readers =
      "i = { type = \"integrator\", in = \"a\" }\nj = { type = \"integrator\", in = \"b\" }\n";
  for (const std::string& blocks : {rest + above + below + readers, readers + below + above + rest}) {
    const oblique::solve::Run run = testing::run_of(testing::Compiled(blocks));
    EXPECT_THAT(testing::row_values(run, "i"), ::testing::Each(0)) << blocks;
    EXPECT_THAT(testing::row_values(run, "j"), ::testing::Each(0)) << blocks;
  }
}

}  // namespace
}  // namespace oblique::solve
