// SPDX-License-Identifier: MIT
// Where a slide ends, and what goes its own way beside another slide.
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

/// z′ = (sin t − sign(z)/2)·size slides until sin t = 1/2, at t = π/6, and comes back to zero where the
/// integral of sin t − 1/2 from there is zero.
constexpr double kLeaves = std::numbers::pi / 6;
double integral(double t) {
  return std::cos(kLeaves) - std::cos(t) - (t - kLeaves) / 2;
}
double comes_back() {
  double before = 3, after = 5;
  while (after - before > 1e-15 * after) {
    const double half = (before + after) / 2;
    if (half == before || half == after) break;
    (integral(half) > 0 ? before : after) = half;
  }
  return before;
}

std::string friction(double size) {
  return fmt::format(R"toml(
one = {{ type = "constant" }}
w = {{ type = "sine-source", frequency = "1 rad/s" }}
z = {{ type = "integrator", in = ["{0}*w", "-0.5*{0}*c"] }}
c = {{ type = "sign", in = "z" }}
turn = {{ type = "integrator", in = "c" }}
)toml",
                     size);
}

class SlideBesideAnother : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Sizes, SlideBesideAnother, ::testing::Values(1, 1e-3, 1e-5));

// While v slides, z leaves its switching surface tangentially, and crosses it once more. It did so 1e-7 late,
// as if it had been resting there all the time.
TEST_P(SlideBesideAnother, IsLeftForGood) {
  const double size = GetParam();
  const oblique::solve::Run result = run_of(Compiled(friction(size) + R"toml(
v = { type = "integrator", in = ["0.3*one", "-s"] }
s = { type = "sign", in = "v" }
)toml"),
                                            {.until = 6});
  const double back = comes_back();
  // The mean of the sign while it slides is 2 sin t.
  const double turn = 2 * (1 - std::cos(kLeaves)) + (back - kLeaves) - (6 - back);
  // The absolute tolerance of 1e-10 over the speed at which z comes back, 1.12 · size, twice; and as much
  // again.
  EXPECT_NEAR(row_values(result, "turn").back(), turn, 1e-7 + 4e-10 / size);
  EXPECT_TRUE(result.warnings.empty());
}

// An integrator at its limit stands on a switching surface as well. Where z left its own it slid along it
// again, since less slides so, and left it at the same instant, until all steps were used up.
TEST(SlideEnd, ComesThoughAnotherStandsAtItsLimit) {
  const oblique::solve::Run result =
      run_of(Compiled(friction(1) + R"toml(v = { type = "integrator", in = ["one"], limit = 0.5 })toml"),
             {.until = 6, .max_steps = 20'000});
  const double back = comes_back();
  const double z = std::cos(back) - std::cos(6) + (6 - back) / 2;
  EXPECT_NEAR(row_values(result, "z").back(), z, 1e-6);  // 100 tolerances: there are five events
}

// v′ = t/1000 − sign(v) breaks loose at t = 1000 s: v = (t − 1000)²/2000. It did so 0.002 s late, where the
// share of one side was certainly beyond 1.
TEST(SlideEnd, IsNoLaterThanItIsKnown) {
  const oblique::solve::Run result = run_of(Compiled(R"toml(
pull = { type = "ramp", slope = 1e-3 }
v = { type = "integrator", in = ["pull", "-f"] }
f = { type = "sign", in = "v" }
)toml"),
                                            {.until = 1000.1});
  EXPECT_NEAR(row_values(result, "v").back(), 5e-6, 2e-10);  // twice the absolute tolerance; it was 2e-9 off
}

// In units so small that a slide and its end are nearer than rounding.
TEST(SlideEnd, ComesInSmallUnits) {
  for (const double size : {1e-8, 1e-10}) {
    const oblique::solve::Run result = run_of(Compiled(fmt::format(R"toml(
w = {{ type = "time-function", formula = "3*sin(1.3*time)", scale = {0} }}
s = {{ type = "comparator", in = "v", low = "-0.6*{0}", high = "0.6*{0}" }}
v = {{ type = "integrator", in = ["w", "-s"] }}
)toml",
                                                                   size)),
                                              {.until = 1, .max_steps = 20'000});
    const double leaves = std::asin(0.2) / 1.3;
    const double v = 3 / 1.3 * (std::cos(1.3 * leaves) - std::cos(1.3)) - 0.6 * (1 - leaves);
    EXPECT_NEAR(row_values(result, "v").back(), v * size, 1e-12) << size;  // a hundredth of the tolerance
  }
}

// An ideal diode: open while neither the voltage drives nor a current flows. At its zero the voltage turns
// its own comparator over as well, and drives the current on both sides of zero: nothing is open there.
TEST(SlideEnd, IsNotDoubtedWhereAnotherTurnsWithIt) {
  const oblique::solve::Run result = run_of(Compiled(R"toml(
u = { type = "time-function", formula = "-cos(time)" }
p = { type = "comparator", in = "u" }
f = { type = "comparator", in = "i" }
pf = { type = "maximum", in = ["p", "f"] }
du = { type = "multiplier", in = ["u", "pf"] }
i = { type = "integrator", in = "du" }
)toml"),
                                            {.until = 3});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_NEAR(row_values(result, "i").back(), 1 - std::sin(3), 1e-7);  // ten tolerances
}

// x′ = −cos t · sign x slides until cos t = 0, and goes as 1 − sin t to one side from then on. The slide of
// y, which x moves and which would move x, goes on: nothing held x any more but that another slid as well.
TEST(Slide, EndsWhereItsSidesDriveApartThoughAnotherGoesOn) {
  for (const char* drive : {"-p", "-p\", \"0.3*y"}) {
    const Compiled made(fmt::format(R"toml(
u = {{ type = "time-function", formula = "cos(time)" }}
s = {{ type = "sign", in = "x" }}
p = {{ type = "multiplier", x = "u", y = "s" }}
x = {{ type = "integrator", in = ["{}"], initial = 0.3 }}
c = {{ type = "sign", in = "y" }}
y = {{ type = "integrator", in = ["-3*c", "0.4*x"], initial = -0.2 }}
)toml",
                                    drive));
    const oblique::solve::Run result = run_of(made, {.until = std::numbers::pi, .samples = 11});
    EXPECT_NEAR(std::abs(row_values(result, "x").back()), 1, 1e-6) << drive;  // as a slide may drift
    ASSERT_EQ(result.warnings.size(), 1U) << drive;
    EXPECT_THAT(result.warnings.front().what, ::testing::HasSubstr("both of its sides drive away"));
  }
}

// The gain of a relay that slides changes its sign at once: what held it drives it away to one side or the
// other.
TEST(Slide, TellsWhereAnEventTurnsItsSidesAround) {
  const Compiled made(R"toml(
u = { type = "step", at = 1.1, from = 1, to = -1 }
s = { type = "sign", in = "-x" }
p = { type = "multiplier", x = "s", y = "u" }
x = { type = "integrator", in = "1.4*p", initial = 0.4 }
)toml");
  const oblique::solve::Run result = run_of(made, {.until = 2, .samples = 11});
  EXPECT_NEAR(std::abs(row_values(result, "x").back()), 1.4 * 0.9, 1e-6);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_THAT(result.warnings.front().what, ::testing::HasSubstr("both of its sides drive away"));
}

// x′ = k (1 + s/2) with s the mixture of a slide, into its limit: both sides drive it there, as slowly as k
// is. (What drives it was taken for zero within the drift of the slide, and the limit was passed.)
TEST(Slide, DrivesAnIntegratorNoFurtherThanItsLimitHoweverSlowly) {
  for (const double k : {1.0, 1e-7, 1e-9, 1e-12}) {
    const Compiled made(fmt::format(R"toml(
one = {{ type = "constant" }}
s = {{ type = "comparator", in = ["-z", "y"], low = -1 }}
y = {{ type = "integrator", in = ["0.3*one", "-0.2*y"], rate = {0:.17g} }}
z = {{ type = "integrator", in = "s", rate = {0:.17g}, initial = 0.1 }}
x = {{ type = "integrator", in = ["one", "0.5*s"], limit = 1.4, rate = {0:.17g} }}
)toml",
                                    k));
    const oblique::solve::Run result = run_of(made, {.until = 2 / k, .samples = 11});
    EXPECT_NEAR(row_values(result, "x").back(), 1.4, 1e-7) << k;
  }
}

// Once the clock is low, b compares twice what a does, which slides: both would turn over together, by a
// share of 0.6 of the time. That b stays low is told.
TEST(Slide, TellsOfWhatWouldTurnOverAlongWithIt) {
  const Compiled made(R"toml(
clock = { type = "step", at = 0.5, from = 1, to = 0 }
a = { type = "comparator", in = "x", low = -1 }
b = { type = "comparator", in = ["2*x", "0.7*clock"] }
x = { type = "integrator", in = ["-3*a", "b"], initial = -0.4 }
)toml");
  const oblique::solve::Run result = run_of(made, {.until = 1});
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(
      result.warnings.front().what,
      "'b' (in > 0) is at zero along with what slides from t = 0.5 s on, and would turn over as often: it "
      "is taken to stay where it is");
}

// x comes to its limit at the moment at which the slide of a ends: rounding may leave a on the side from
// which it will turn over soon after, where both sides of the limit drive away alike. Truth: Euler steps of a
// ten-millionth of the run, to 1e-6. (There were no shares, and the run was refused by one method or another,
// as the unit of time had it.)
TEST(Slide, IsOverWhereBothSidesDriveAwayAlike) {
  for (const double k : {1.0, 1e-3, 1e-5, 1e-6, 1e-7}) {
    const Compiled made(fmt::format(R"toml(
one = {{ type = "constant", value = 1 }}
a = {{ type = "comparator", in = ["1.663*y", "-1.91*x", "-0.224*one"], low = -1 }}
b = {{ type = "comparator", in = ["-0.91*z", "-0.32*x"], low = -1 }}
x = {{ type = "integrator", in = ["1.3*a", "-1.05*b"], initial = -0.8, limit = 1.4, rate = {0:.17g} }}
y = {{ type = "integrator", in = ["-3.2417*b", "-1.01*a", "-0.245*y"], initial = -0.77, rate = {0:.17g} }}
z = {{ type = "integrator", in = ["0.54*a", "0.69*x", "-0.4805*z"], initial = 0.7, rate = {0:.17g} }}
)toml",
                                    k));
    for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                              diagram::IntegrationMethod::rodas}) {
      const oblique::solve::Run result = run_of(made, {.until = 2 / k, .samples = 11, .method = method});
      EXPECT_NEAR(row_values(result, "x").back(), 1.4, 1e-7) << k;
      EXPECT_NEAR(row_values(result, "y").back(), 3.237803, 2e-6) << k;
    }
  }
}

// Three masses with dry friction on the ground and on each other. When the second comes to rest, at which the
// third already is, three frictions hold two masses: the one between them rests along, on a side on which the
// others can hold. (It was put where they cannot, having nothing to compare: their slide ended and began
// again, at every rounding of the time.) The methods bear each other out, to their tolerance of 1e-8 by some
// hundred.
TEST(Slide, GoesOnBesideAFrictionThatNothingDetermines) {
  const Compiled made(R"toml(
u = { type = "time-function", formula = "1.676*sin(2.969*time + 2.46)" }
g1 = { type = "sign", in = "v1" }
g2 = { type = "sign", in = "v2" }
d0 = { type = "summer", in = ["v0", "-v1"] }
h0 = { type = "sign", in = "d0" }
d1 = { type = "summer", in = ["v1", "-v2"] }
h1 = { type = "sign", in = "d1" }
p0 = { type = "integrator", in = "v0", initial = 0.59 }
v0 = { type = "integrator", in = ["-1.2*p0", "-2.94*p0", "2.94*p1", "-0.2*h0", "u"], rate = 1.7, initial = 0.75 }
p1 = { type = "integrator", in = "v1", initial = -0.34 }
v1 = { type = "integrator", in = ["-1.89*p1", "-0.4*v1", "-1.009*g1", "-2.94*p1", "2.94*p0", "0.2*h0", "-0.4*h1"], rate = 2.1, initial = 0 }
p2 = { type = "integrator", in = "v2", initial = -0.97 }
v2 = { type = "integrator", in = ["-0.94*p2", "-0.26*v2", "-0.6*g2", "0.4*h1"], rate = 1.983, initial = 0 }
)toml");
  std::vector<double> ends;
  for (const auto method : {diagram::IntegrationMethod::bdf, diagram::IntegrationMethod::adams,
                            diagram::IntegrationMethod::rodas}) {
    const oblique::solve::Run result = run_of(
        made,
        {.until = 8.0153, .samples = 41, .max_steps = 4000 /* a few took 2e-3 s each */, .method = method});
    EXPECT_EQ(result.warnings.size(), 2U);  // of h1 and of g2, which are at zero along with the others
    for (const char* name : {"p0", "v0", "p1", "v1", "p2", "v2"})
      ends.push_back(row_values(result, name).back());
  }
  for (std::size_t k = 6; k < ends.size(); ++k) EXPECT_NEAR(ends[k], ends[k % 6], 1e-7) << k;
}

// A row of three masses, two of them with dry friction, that stick now and then. A comparison that rests
// along with what slides is known to turn over as often: that it nearly does says nothing of what follows.
// Both methods agree to ten times their tolerance of 1e-8, and what they tell is of what rests along.
TEST(Slide, TellsOfNoTurnOfWhatRestsAlongWithIt) {
  const Compiled made(R"toml(
u = { type = "time-function", formula = "1.44*sin(1.25*time) + 0.48*cos(6.9*time)" }
clk = { type = "pulse-train", period = 0.933, width = 0.17, delay = 0.2 }
g0 = { type = "sign", in = "v0" }
g1 = { type = "sign", in = "v1" }
d0 = { type = "summer", in = ["v0", "-v1"] }
h0 = { type = "sign", in = "d0" }
p0 = { type = "integrator", in = "v0", initial = 0.55 }
v0 = { type = "integrator", in = ["-0.32*p0", "-1.07*g0", "-0.9*p0", "0.9*p1", "-0.557*h0", "u"], rate = 0.506, initial = 0.106 }
p1 = { type = "integrator", in = "v1", initial = 0.11 }
v1 = { type = "integrator", in = ["-0.717*p1", "-0.37*g1", "-0.9*p1", "0.9*p0", "0.557*h0", "-2.703*p1", "2.703*p2", "-0.601*clk"], rate = 2.25, initial = 0 }
p2 = { type = "integrator", in = "v2", initial = -0.11 }
v2 = { type = "integrator", in = ["-0.7*p2", "-0.134*v2", "-2.703*p2", "2.703*p1"], rate = 0.9, initial = 0 }
)toml");
  std::vector<double> ends;
  for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf}) {
    const oblique::solve::Run result = run_of(made, {.until = 8.0153, .samples = 41, .method = method});
    for (const text::Diagnostic& warning : result.warnings)
      EXPECT_THAT(warning.what, ::testing::HasSubstr("is at zero along with what slides"));
    for (const char* name : {"p0", "v0", "p1", "v1", "p2", "v2"})
      ends.push_back(row_values(result, name).back());
  }
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(ends[k], ends[k + 6], 1e-7) << k;
}

/// A comparator that ends what moves the integrator i which it compares, and gates a clock for the counter n;
/// m counts the turns of the comparator itself.
Compiled gated_clock(const std::string& integrator) {
  return Compiled(integrator + R"toml(
one = { type = "constant" }
on = { type = "comparator", in = ["i"] }
clock = { type = "pulse-train", period = 0.00317, width = 0.001 }
gated = { type = "multiplier", in = ["clock", "on"] }
n = { type = "counter", clock = "gated" }
m = { type = "counter", clock = "on" }
)toml");
}

}  // namespace
// i comes to zero at 0.5 and rests there: below nothing moves it. The clock has its edges at multiples of
// 0.00317: 158 of them come before that, and more than 1000 turns of its gate after. The comparator
// holds from the start, which is no turn.
TEST(Slide, ThatRestsOnOneSideIsThereToWhatCounts) {
  const Compiled made = gated_clock(R"toml(i = { type = "integrator", in = ["-on"], initial = 0.5 })toml");
  for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                            diagram::IntegrationMethod::rodas}) {
    const auto result = run_of(made, {.until = 10, .samples = 11, .method = method});
    EXPECT_TRUE(result.warnings.empty()) << result.warnings.front().what;
    EXPECT_EQ(row_values(result, "n.out").back(), 158);
    EXPECT_EQ(row_values(result, "m.out").back(), 0);
  }
}

// Above nothing moves it: there the comparator has come on once, and of the 1262 edges until 4 s all but 158
// are counted.
TEST(Slide, ThatRestsAboveHasTurnedOverOnce) {
  const Compiled made =
      gated_clock(R"toml(i = { type = "integrator", in = ["one", "-on"], initial = -0.5 })toml");
  const auto result = run_of(made, {.until = 4, .samples = 11});
  EXPECT_TRUE(result.warnings.empty()) << result.warnings.front().what;
  EXPECT_EQ(row_values(result, "n.out").back(), 1262 - 158);
  EXPECT_EQ(row_values(result, "m.out").back(), 1);
}

TEST(Slide, OfALimitIsLeftWhereItsDriveJumpsBack) {
  const Compiled made(R"toml(s = { type = "step", at = 3, from = 1, to = -1 }
w = { type = "integrator", in = ["s"], limit = 0.3 }
)toml");
  const auto result = run_of(made, {.until = 3.2, .samples = 5});
  EXPECT_NEAR(row_values(result, "w").back(), 0.1, 1e-7);  // ten tolerances
  EXPECT_TRUE(result.warnings.empty()) << result.warnings.front().what;
}

// x comes to zero at 0.5 and rests there, until at 1 what drives it on the one side jumps away: it could as
// well stay, which is told, whether or not anything counts the turns.
TEST(Slide, ThatCouldAsWellStayGoesWhereItIsDriven) {
  for (const std::string counter : {"", "n = { type = \"counter\", clock = \"c\" }\n"}) {
    const Compiled made(R"toml(g = { type = "step", at = 1, from = -1, to = 1 }
c = { type = "comparator", in = ["x"] }
m = { type = "multiplier", in = ["g", "c"] }
x = { type = "integrator", in = ["m"], initial = 0.5 }
)toml" + counter);
    const auto result = run_of(made, {.until = 2, .samples = 5});
    EXPECT_NEAR(row_values(result, "x").back(), 1, 1e-7);  // ten tolerances
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_THAT(result.warnings.front().what, ::testing::EndsWith("it could as well stay"));
  }
}

// c is driven through a gate: while that is closed it stands still at its limit, beside z, which goes on at
// its own. Where the gate opens c is driven against its limit again, and does not pass it, not even by what a
// slide drifts.
TEST(Slide, BesideWhichSomethingIsDrivenAgainHoldsItToItsLimit) {
  const Compiled made(R"toml(p = { type = "pulse-train", period = 0.5, width = 0.35 }
m = { type = "multiplier", x = "p", y = "d" }
d = { type = "summer", in = ["0.8*z", "-0.6*c"] }
c = { type = "integrator", in = ["m"], rate = 0.9, initial = 0.5, limit = 0.7 }
x = { type = "time-function", formula = "exp(-0.2*time)" }
z = { type = "integrator", in = ["0.6*x"], initial = 0.35, limit = 0.74 }
)toml");
  const auto result = run_of(made, {.until = 7, .tolerance = 1e-10});
  EXPECT_NEAR(row_values(result, "c").back(), 0.7, 1e-11);  // a tenth of the tolerance
}

}  // namespace oblique::solve
