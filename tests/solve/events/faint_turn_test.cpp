// SPDX-License-Identifier: MIT
// Comparisons of what decays: the sign is known for ever, and the absolute tolerance hides it.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

// x = e^(−t/τ)/2 never passes zero, so that the comparator never drives it to −1/2.
TEST(FaintTurn, OfADecayIsNone) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const testing::Compiled made(R"(
x = { type = "transfer-lag", in = "-0.5*c", time_constant = 1e-3, initial = 0.5 }
c = { type = "comparator", in = "-x" }
)",
                                 "[outputs]\nx = { signal = \"x\" }\nc = { signal = \"c\" }\n");
    RunOptions options;
    options.until = 0.5;  // 500 τ: e^(−500) = 7e-218
    options.tolerance = tolerance;
    const auto found = oblique::solve::run(made.program, made.flat, options);
    const std::size_t last = found.trajectory.rows() - 1;
    EXPECT_NEAR(found.trajectory.at(last, 1), 0, 1e-15) << tolerance;
    EXPECT_EQ(found.trajectory.at(last, 2), 0) << tolerance;
    EXPECT_THAT(found.warnings, IsEmpty());
  }
}

// x = e^(−t) cos 10 t: its zeros go on as ever, 76 of them until t = 24, where x is 4e-11.
TEST(FaintTurn, OfADecayedOscillationComesInTime) {
  const testing::Compiled made(R"(
x = { type = "integrator", in = "v", initial = 1 }
v = { type = "integrator", in = ["-101*x", "-2*v"], initial = -1 }
c = { type = "comparator", in = "x" }
)");
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const auto found = testing::run_of(made, {.until = 24, .tolerance = tolerance});
    ASSERT_EQ(found.event_count, 76) << tolerance;
    EXPECT_THAT(found.warnings, IsEmpty());
    // what is compared must differ by 1e-13, at a speed of 10 e^(−24) in the end
    for (std::size_t k = 0; k < found.events.size(); ++k)
      EXPECT_NEAR(found.events[k].time, (static_cast<double>(k) + 0.5) * std::numbers::pi / 10, 3e-4);
  }
}

/// A run, and how often it was begun anew.
struct Counted {
  explicit Counted(const testing::Compiled& made, double until, double tolerance) {
    RunOptions options;
    options.until = until;
    options.tolerance = tolerance;
    options.on_restart = [this] { ++restarts; };
    run = oblique::solve::run(made.program, made.flat, options);
  }
  int restarts = 0;
  Run run;
};

// Slow beside the steps that something else wants, but not beside its own way: its moment is known to 1e-6 s.
TEST(FaintTurn, IsNotWhatTheStepsOfOthersCutFine) {
  const testing::Compiled made(R"(
one = { type = "constant", value = 1 }
x = { type = "integrator", in = "0.001*one", initial = -0.0005 }
u = { type = "integrator", in = "1000*w", initial = 1 }
w = { type = "integrator", in = "-1000*u" }
c = { type = "comparator", in = "x" }
)");
  const Counted counted(made, 1, 1e-6);
  ASSERT_EQ(counted.run.event_count, 1);
  EXPECT_NEAR(counted.run.events.front().time, 0.5, 1e-6);
  EXPECT_THAT(counted.run.warnings, IsEmpty());
  EXPECT_EQ(counted.restarts, 0);
}

const char* const kDecayedOscillation = R"(
x = { type = "integrator", in = "v", initial = 1 }
v = { type = "integrator", in = ["-101*x", "-2*v"], initial = -1 }
c = { type = "%s", in = "x" }
)";

// x = 1 + e^(−t)/2 never passes 1, and no tolerance knows it better than by an error of 1: where one of these
// errors has let it pass, and so to 1/2, the run says so.
TEST(FaintTurn, OfADecayToALevelIsToldOf) {
  const testing::Compiled made(R"(
one = { type = "constant", value = 1 }
x = { type = "integrator", in = ["one", "-0.5*c", "-x"], initial = 1.5 }
c = { type = "comparator", in = ["one", "-x"] }
)",
                               "[outputs]\nx = { signal = \"x\" }\nc = { signal = \"c\" }\n");
  for (const double tolerance : {1e-3, 1e-4, 1e-6, 1e-8, 1e-10}) {
    const Counted counted(made, 60, tolerance);
    const std::size_t last = counted.run.trajectory.rows() - 1;
    ASSERT_EQ(counted.run.trajectory.at(last, 2), 1) << tolerance << ": it did not pass, so nothing is shown";
    ASSERT_THAT(counted.run.warnings, SizeIs(1)) << tolerance;
    EXPECT_THAT(text::to_string(counted.run.warnings.front()),
                AllOf(HasSubstr("'c' (in > 0) turns over at t = "),
                      EndsWith(fmt::format(
                          " s, where what it compares is equal to within {:.2g}, which is its error: "
                          "what follows may be wrong\n  remedy: compare with a level that is passed, "
                          "give the comparison a hysteresis, or end the run before",
                          tolerance))));
  }
}

// x = e^(−t/τ) is read by a comparator that drives nothing, while pulses let the solver begin anew: whatever
// the steps, it never turns over, and no event is told of that there is not.
TEST(FaintTurn, OfADecayMakesNoEvents) {
  const testing::Compiled made(R"(
x = { type = "transfer-lag", in = "0*x", time_constant = 0.21875, initial = 1 }
c = { type = "comparator", in = "-x", high = 0.8 }
pulses = { type = "pulse-train", period = 0.8, width = 0.28 }
)");
  for (const auto method : {diagram::IntegrationMethod::bdf, diagram::IntegrationMethod::adams}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      RunOptions options;
      options.until = 20;
      options.tolerance = tolerance;
      options.method = method;
      const auto found = oblique::solve::run(made.program, made.flat, options);
      EXPECT_EQ(testing::row_values(found, "c").back(), 0) << tolerance;
      for (const EventRecord& event : found.events)
        EXPECT_THAT(event.what, StartsWith("pulses")) << tolerance;
      EXPECT_THAT(found.warnings, IsEmpty()) << tolerance;
    }
  }
}

// 0.5 cos t comes back to 0.5, the level of the counter, and no farther: what it counts, errors decide. The
// counter at 0.4 passes its level, and that at 0.6 never comes to it.
TEST(FaintTurn, OfWhatTouchesItsLevelIsToldOf) {
  for (const auto& [weight, counts, warned] :
       {std::tuple(0.5 / 0.4, 3.0, false), {1.0, -1.0, true}, {0.5 / 0.6, 0.0, false}}) {
    const testing::Compiled made(fmt::format(R"(
x = {{ type = "integrator", in = "v", initial = 1 }}
v = {{ type = "integrator", in = "-x" }}
n = {{ type = "counter", clock = "{}*x" }}
)",
                                             0.5 * weight));
    bool any = false;
    for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
      const oblique::solve::Run run = testing::run_of(made, {.until = 20, .tolerance = tolerance});
      const double counted = testing::row_values(run, "n.out").back();
      any = any || !run.warnings.empty();
      if (counted != 0 && warned) {
        EXPECT_THAT(run.warnings, SizeIs(1)) << tolerance;
      }
      if (!warned) {
        EXPECT_EQ(counted, counts) << tolerance;
        EXPECT_THAT(run.warnings, IsEmpty()) << tolerance;
      }
    }
    EXPECT_EQ(any, warned) << "at no tolerance do errors let it pass, so that nothing is shown";
  }
}

// a (cos ωt − 1) comes up to zero, and no farther: what its sign drives behind −9100 stays at 9100. Errors
// let it pass by some of themselves, and the amplifier goes a percent off for a moment. Where it does, that
// is told.
TEST(FaintTurn, IsToldOfWhereErrorsLetALevelBePassed) {
  for (const double amplitude : {0.05, 0.06, 0.07, 0.08, 0.09, 0.1, 0.11, 0.12}) {
    const testing::Compiled made(fmt::format(R"(
w = {{ type = "sine-source", amplitude = {}, frequency = 3.91203125 }}
x = {{ type = "integrator", in = "-w", rate = 1.25 }}
s = {{ type = "sign", in = "2*x" }}
y = {{ type = "servo-amplifier", in = "s", gain = 9100, bandwidth = 10.335625 }}
)",
                                             amplitude),
                                 "[outputs]\ny = \"y\"\n");
    const oblique::solve::Run run = testing::run_of(made, {.until = 1.5, .tolerance = 1e-7});
    const std::vector<double> y = testing::row_values(run, "y");
    const bool stays = std::all_of(y.begin() + static_cast<std::ptrdiff_t>(y.size() / 5), y.end(),
                                   [](double value) { return std::abs(value - 9100) < 1; });
    EXPECT_TRUE(stays || !run.warnings.empty()) << amplitude;
  }
}

// What another block sets at an instant does not move a decay: the sign of x = e^(−t/τ) stays, though a lag
// is set back again and again while x is within rounding of zero.
TEST(FaintTurn, IsNotMadeByWhatOthersSet) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("spiker", R"toml(
[inputs]
in = { doc = "[machine unit]" }
[outputs]
out = { doc = "[machine unit]" }
[equations]
"der(out)" = "in - 0.5*out"
[start]
out = 0
[[events]]
when = "out > 0.1"
set = { out = 0 }
)toml");
  const testing::Compiled made(R"(
one = { type = "constant", value = 1 }
x = { type = "transfer-lag", in = "0*x", time_constant = 0.2, initial = -1 }
s = { type = "sign", in = "x" }
k = { type = "spiker", in = "one" }
)",
                               "", library);
  for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    const oblique::solve::Run run = testing::run_of(made, {.until = 20, .tolerance = tolerance});
    EXPECT_GT(run.event_count, 100);
    EXPECT_THAT(testing::row_values(run, "s"), ::testing::Each(-1)) << tolerance;
  }
}

// e^(−10 t) is 6e-14 at t = 3.05, where a step comes: nearer to zero than rounding of a machine unit, but
// known to a millionth of itself, it has not passed it.
TEST(FaintTurn, IsNotDecidedByAnotherEventWhereTheSideIsKnown) {
  const testing::Compiled made(R"(
u = { type = "step", at = 3.05 }
x = { type = "transfer-lag", in = "0*x", time_constant = 0.1, initial = 1 }
c = { type = "comparator", in = "x" }
y = { type = "integrator", in = ["u", "-y"] }
)",
                               "[outputs]\nc = { signal = \"c\" }\n");
  RunOptions options;
  options.until = 3.1;
  options.tolerance = 1e-6;
  options.absolute_tolerance = 1e-30;
  const oblique::solve::Run run = oblique::solve::run(made.program, made.flat, options);
  EXPECT_THAT(testing::row_values(run, "c"), ::testing::Each(1));
  EXPECT_THAT(run.warnings, IsEmpty());
}

// Decays far faster than the steps, in which Adams' method leaves small errors of either sign that move
// quickly: the edges of a clock come upon all of them, and none turns the comparator over.
TEST(FaintTurn, IsNotDecidedByAnotherEventWhereErrorsMoveQuickly) {
  for (const char* const time_constant : {"1e-6", "3e-6", "1e-5"}) {
    for (const double tolerance : {1e-6, 1e-7, 1e-8, 1e-10}) {
      const testing::Compiled made(fmt::format(R"(
p = {{ type = "pulse-train", period = 1, width = 0.25434 }}
x = {{ type = "transfer-lag", in = "0*p", time_constant = {}, initial = 0.75 }}
c = {{ type = "comparator", in = "0.5*x" }}
z = {{ type = "pade-delay-2", in = "-0.5*x", delay = 0.6875 }}
)",
                                               time_constant));
      const oblique::solve::Run run = testing::run_of(
          made, {.until = 9.5, .tolerance = tolerance, .method = diagram::IntegrationMethod::adams});
      EXPECT_THAT(testing::row_values(run, "c"), ::testing::Each(1)) << time_constant << ' ' << tolerance;
    }
  }
}

// A decay that the errors of the states let touch zero, at t = 0.44, and go back: what steps later, by which
// time it is anywhere within them, does not turn it over either. (−x stays below zero for ever.)
TEST(FaintTurn, IsNotDecidedByAnotherEventWhereZeroWasTouched) {
  const testing::Compiled made(R"(
u = { type = "step", at = 1.6 }
m = { type = "minimum", x = "-x", y = "-2*x" }
x = { type = "transfer-lag", in = "0.5*m", time_constant = 0.03125, initial = 0.5 }
f = { type = "function-generator", in = "-x", points = [[-1, 0.5], [0, 0], [0, 1], [1, 1]] }
)");
  for (const double tolerance : {1e-7, 1e-8, 1e-9}) {
    RunOptions options;
    options.until = 4;
    options.tolerance = tolerance;
    options.method = diagram::IntegrationMethod::bdf;
    const oblique::solve::Run run = oblique::solve::run(made.program, made.flat, options);
    EXPECT_NEAR(testing::row_values(run, "f").back(), 0, 1e-10) << tolerance;  // of the jump nothing
    EXPECT_THAT(run.warnings, IsEmpty());
  }
}

// sin t beside a level a billionth above its amplitude, which is within its error, or at it, or a
// ten-millionth above it, which errors come to in a long run; and, far enough beside these, a
// hundred-thousandth.
TEST(FaintTurn, ThatDidNotComeIsToldOf) {
  const auto warnings_at = [](const std::string& level) {
    const testing::Compiled made(R"(
x = { type = "integrator", in = "v" }
v = { type = "integrator", in = "-x", initial = 1 }
l = { type = "constant", value = )" +
                                 level + R"( }
c = { type = "comparator", in = ["x", "-l"] }
n = { type = "counter", clock = "c" }
)");
    const oblique::solve::Run run = testing::run_of(made, {.until = 20});
    EXPECT_EQ(testing::row_values(run, "n.out").back(), 0) << level;
    return run.warnings;
  };
  for (const char* const level : {"1.0000001", "1.000000001", "1"}) {
    const auto warnings = warnings_at(level);
    ASSERT_EQ(warnings.size(), 1U) << level;
    EXPECT_THAT(warnings[0].what, HasSubstr("'c' (in > 0) does not turn over at t = 1.5707963")) << level;
  }
  EXPECT_THAT(warnings_at("1.00001"), IsEmpty());
}

// A turn that nobody reads is not told of, nor one of what only bends.
TEST(FaintTurn, ThatDidNotComeAndChangesNothingIsNotToldOf) {
  const testing::Compiled made(R"(
x = { type = "integrator", in = "v" }
v = { type = "integrator", in = "-x", initial = 1 }
one = { type = "constant" }
m = { type = "maximum", in = ["x", "one"] }
l = { type = "limiter", in = "x", low = -1, high = 1 }
)");
  EXPECT_THAT(testing::run_of(made, {.until = 20}).warnings, IsEmpty());
}

// A delayed trigger at an amplitude is never above it; where errors let it be, what is made of that comes
// later only, by its delay, and is told of all the same. (What else is there cuts the steps.)
TEST(FaintTurn, ThatOnlyAMemoryKeepsIsToldOf) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("delayed-trigger", R"(
[inputs]
in = {}
[outputs]
out = {}
[memories]
since = 1e9
fired = 0
[equations]
out = "fired"
[[events]]
when = "in > 1"
set = { since = "time" }
[[events]]
when = "time - since >= 0.06"
set = { fired = 1 }
)");
  const testing::Compiled made(R"(
x = { type = "crank-generator", rate = -2.5 }
y = { type = "crank-generator", rate = 1 }
z = { type = "transfer-lag", in = "x.sin", time_constant = 0.09375, gain = 1.5 }
c = { type = "comparator", in = ["y.sin", "-0.5*y.cos", "-2*z"], hysteresis = 0.5 }
r = { type = "delayed-trigger", in = "-x.cos" }
)",
                               "", library);
  int wrong = 0;
  for (double tolerance = 1e-9; tolerance < 2e-6; tolerance *= 2) {
    const oblique::solve::Run run = testing::run_of(made, {.until = 3.5, .tolerance = tolerance});
    const auto r = testing::row_values(run, "r");
    const bool pulls_in = std::find(r.begin(), r.end(), 1) != r.end();
    EXPECT_TRUE(!pulls_in || !run.warnings.empty()) << tolerance;
    wrong += pulls_in ? 1 : 0;
  }
  EXPECT_GT(wrong, 0);  // else there is nothing to tell of
}

// What rests at its level until a step or a pulse sets it off is passed for good: x = 1 − e^(1 − t).
TEST(FaintTurn, IsNotWhatAStepSetsOff) {
  for (const char* const follows : {R"(x = { type = "transfer-lag", in = "u" })",
                                    R"(x = { type = "integrator", in = "y" }
y = { type = "integrator", in = ["u", "-y"] })"}) {
    const testing::Compiled made("u = { type = \"step\", at = 1 }\n" + std::string(follows) +
                                 "\nc = { type = \"comparator\", in = \"x\" }\n");
    const oblique::solve::Run run = testing::run_of(made, {.until = 3});
    EXPECT_THAT(run.warnings, IsEmpty());
    EXPECT_EQ(testing::row_values(run, "c").back(), 1);
    EXPECT_EQ(testing::row_values(run, "c").front(), 0);
  }
}

// Four lags behind a sign, closed by it against its sense, at rest: any solution leaves zero, through
// infinitely many turns, in a rhythm that nothing gives. So the first that the run sees is decided by errors.
TEST(FaintTurn, AtTheStartIsToldOf) {
  const testing::Compiled made(R"(
x1 = { type = "integrator", in = ["s", "-0.5*x1"], rate = 3.5 }
x2 = { type = "transfer-lag", in = "-x1", time_constant = 0.09 }
x3 = { type = "transfer-lag", in = "-x2", time_constant = 0.4 }
x4 = { type = "transfer-lag", in = "0.3*x3", time_constant = 0.5 }
s = { type = "sign", in = "-x4" }
)");
  for (const double until : {2.0, 50.0}) {
    const oblique::solve::Run run = testing::run_of(made, {.until = until});
    ASSERT_GT(run.event_count, 3);
    EXPECT_FALSE(run.warnings.empty()) << until;
  }
}

// The square of a ramp is zero until the ramp begins, and leaves zero with the rate 0: no error is in that.
TEST(FaintTurn, IsNotWhatFollowsTheTimeAlone) {
  const testing::Compiled made(R"(
k = { type = "ramp", slope = 0.5, start = 1 }
q = { type = "squarer", in = "k" }
s = { type = "sign", in = "q" }
x = { type = "integrator", in = ["s"] }
)");
  const oblique::solve::Run run = testing::run_of(made, {.until = 4});
  EXPECT_THAT(run.warnings, IsEmpty());
  EXPECT_NEAR(testing::row_values(run, "x").back(), -1 + 3, 1e-7);  // ten tolerances
}

// A kink is passed without an effect: |x| of a decay is as exact on both sides. A jump is not.
TEST(FaintTurn, WithoutAnEffectIsNoMatter) {
  for (const auto& [type, restarts] : {std::pair("absolute-value", 0), std::pair("comparator", 1)}) {
    std::string blocks = kDecayedOscillation;
    blocks.replace(blocks.find("%s"), 2, type);
    const Counted counted(testing::Compiled(blocks), 24, 1e-6);
    EXPECT_THAT(counted.run.warnings, IsEmpty());
    EXPECT_EQ(counted.restarts, restarts) << type;
  }
}

}  // namespace
}  // namespace oblique::solve
