// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/rest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::failure_of;
using ::testing::HasSubstr;

/// A diagram brought to rest at t = 0.
struct Rested {
  Compiled made;
  std::vector<double> states;
  std::vector<double> derivatives;

  explicit Rested(std::string_view blocks)
      : made(blocks), states(made.program.start()), derivatives(states.size()) {
    network::Workspace workspace(made.program);
    bring_to_rest(made.program, workspace, 0, states, "d.toml");
    if (!made.program.derivatives(0, states.data(), derivatives.data(), workspace))
      throw std::runtime_error("no derivatives");
  }

  double state(std::string_view name) const {
    const auto& all = made.program.states();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].name == name) return states[i];
    }
    throw std::out_of_range(std::string(name));
  }

  /// Largest residual of the servo loops: dx/dt without its factor μ/τ.
  double residual(double gain, double bandwidth = 10) const {
    double largest = 0;
    for (const std::size_t i : rest_states(made.program))
      largest = std::max(largest, std::abs(derivatives[i]));
    return largest / (2 * std::numbers::pi * bandwidth * gain);
  }
};

constexpr double kRounding = 1e-14;  // of a residual whose terms are of order 1 to 10 (input_gain)

TEST(Rest, TakesServoLoopsToTheirEquationAndHoldsIntegrators) {
  const Rested at(R"toml(x  = { type = "integrator", in = ["one"], initial = 0.6 }
one = { type = "constant" }
z  = { type = "constant", value = 0.3 }
q  = { type = "divider", numerator = "z", denominator = "x", gain = 1e6 }
)toml");
  EXPECT_EQ(at.state("x"), 0.6);
  EXPECT_EQ(at.derivatives[0], 1);  // the clock only stood still
  EXPECT_NEAR(at.state("q.quotient"), 0.3 / (0.6 + 1e-6), 1e-15);
  EXPECT_LT(at.residual(1e6), kRounding);
}

TEST(Rest, ChoosesTheRootThatIsStableFromItsInitial) {
  const auto root = [](double initial) {
    return Rested(fmt::format(R"toml(u  = {{ type = "constant", value = 0.49 }}
cc = {{ type = "multiplier", in = ["c", "c"] }}
c  = {{ type = "servo-amplifier", in = ["cc", "-u"], gain = 1e5, initial = {} }}
)toml",
                              initial))
        .state("c");
  };
  for (const double initial : {0.0, 0.1, 1.0, 5.0}) EXPECT_NEAR(root(initial), 0.7, 1e-5) << initial;
}

// From c = 0 the loop c² = u has no gain, and its output sets out at 2π·bandwidth·μ·u: for μ = 1e14 a step of
// the time constant that the guess knows of goes 1e14 times too far.
TEST(Rest, SetsOutWhereALoopHasNoGainYet) {
  for (const double gain : {1e4, 1e7, 1e8, 1e9, 1e10, 1e12, 1e14}) {
    const Rested at(fmt::format(R"toml(u  = {{ type = "constant", value = 0.49 }}
cc = {{ type = "multiplier", in = ["c", "c"] }}
c  = {{ type = "servo-amplifier", in = ["cc", "-u"], gain = {}, initial = 0 }}
)toml",
                                gain));
    // c² + c/μ = u, solved for c; its rounding
    EXPECT_NEAR(at.state("c"), -0.5 / gain + std::hypot(0.5 / gain, 0.7), 1e-15) << gain;
  }
}

TEST(Rest, ReachesLoopsOfVeryDifferentSpeeds) {
  // A chain of divisions by 0.5 through amplifiers from 1 Hz to 1 MHz and gains from 1e2 to 1e8.
  const Rested at(R"toml(one  = { type = "constant" }
half = { type = "constant", value = 0.5 }
a = { type = "divider", numerator = "one", denominator = "half", gain = 1e2, bandwidth = "1 Hz" }
b = { type = "divider", numerator = "a", denominator = "half", gain = 1e8, bandwidth = "1 MHz" }
c = { type = "divider", numerator = "b", denominator = "half", gain = 1e5, bandwidth = "100 Hz" }
)toml");
  const double a = 1 / (0.5 + 1e-2), b = a / (0.5 + 1e-8), c = b / (0.5 + 1e-5);
  EXPECT_NEAR(at.state("a.quotient"), a, 1e-14);
  EXPECT_NEAR(at.state("b.quotient"), b, 1e-14);
  EXPECT_NEAR(at.state("c.quotient"), c, 1e-13);
}

//  Two dyads, the second on the apex of the first, as in Jansen's leg. Until the first has settled its apex
//  is far from where the links of the second reach.
//
//        C ───── D          P = (0, 0), Q = (0.5, 0), C by links 0.4 and 0.3: a right angle, C = (0.32, 0.24)
//      /   \    /           R = (1.2, 0.24), D on C and R by links 0.5 and 0.4
//     P     Q  R

constexpr const char* kTwoDyads = R"toml(o  = {{ type = "constant", value = 0 }}
qx = {{ type = "constant", value = 0.5 }}
rx = {{ type = "constant", value = 1.2 }}
ry = {{ type = "constant", value = 0.24 }}
c  = {{ type = "dyad-rrr", px = "o", py = "o", qx = "qx", qy = "o", r1 = 0.4, r2 = 0.3, gain = {0} }}
d  = {{ type = "dyad-rrr", px = "c.x", py = "c.y", qx = "rx", qy = "ry", r1 = 0.5, r2 = 0.4, gain = {0} }}
)toml";

TEST(Rest, SettlesGroupAfterGroupWhereAllAtOnceFail) {
  constexpr double kGain = 1e6;
  const Rested at(fmt::format(kTwoDyads, kGain));
  EXPECT_LT(at.residual(kGain), 1e-13);  // as kRounding, with weights of 10
  network::Workspace workspace(at.made.program);
  std::vector<double> signals(at.made.program.n_signals());
  ASSERT_TRUE(at.made.program.signals(0, at.states.data(), signals.data(), workspace));
  // The foot of the height of D on C–R (length 0.88) by Pythagoras.
  constexpr double kFoot = (0.88 * 0.88 + 0.25 - 0.16) / (2 * 0.88);
  const double height = std::sqrt(0.25 - kFoot * kFoot);
  // The static errors of ten loops of slope 1 to 10, each 1e-6, through a triangle of gain below ten.
  EXPECT_NEAR(signals[at.made.signal("c.cx")], 0.32, 1e-5);
  EXPECT_NEAR(signals[at.made.signal("c.cy")], 0.24, 1e-5);
  EXPECT_NEAR(signals[at.made.signal("d.cx")], 0.32 + kFoot, 1e-5);
  EXPECT_NEAR(signals[at.made.signal("d.cy")], 0.24 + height, 1e-5);
}

TEST(Rest, ReachesRoundingNearADeadCentre) {
  // sin γ = 1e-3 or so: rounding of sin² + cos² − 1 moves it by 1e-13, where Newton's method then wanders
  // about.
  for (const double side : {0.699999, 0.6999999, 0.699990}) {
    const Rested at(fmt::format(R"toml(l = {{ type = "constant", value = {} }}
t = {{ type = "triangle-two-sides", side = "l", adjacent = 0.4, opposite = 0.3, gain = 1e6 }}
)toml",
                                side));
    EXPECT_LT(at.residual(1e6), 1e-13) << side;  // rounding of terms of order 10 (input_gain)
  }
}

TEST(Rest, NeedsNothingWithoutServoLoops) {
  const Rested at("x = { type = \"integrator\", in = [\"x\"], initial = 0.25 }\n");
  EXPECT_TRUE(rest_states(at.made.program).empty());
  EXPECT_EQ(at.states, std::vector<double>{0.25});
}

TEST(Rest, MakesARunStartWithoutATransient) {
  // q = 0.3/(0.5 + …) from the first row on: a loop that had to settle would start at 0.
  const Compiled made(R"toml(one = { type = "constant" }
z = { type = "constant", value = 0.3 }
x = { type = "integrator", in = ["0.5*one"], initial = 0.5 }
d = { type = "divider", numerator = "z", denominator = "x", gain = 1e6 }
)toml");
  const auto q = testing::row_values(testing::run_of(made, {.until = 1e-6, .samples = 101}), "d");
  for (const double value : q) EXPECT_NEAR(value, 0.6, 3e-6);
}

// Loops that do not settle.

TEST(Rest, RefusesPositiveFeedback) {
  //  r = z − q falls with q: the output runs to the rail.
  const Compiled made(R"toml(z = { type = "constant", value = 0.3 }
q = { type = "servo-amplifier", in = ["z", "-q"] }
)toml");
  const auto failure = failure_of(made);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, SolveError::Kind::no_rest);
  EXPECT_EQ(failure->time, 0);
  EXPECT_THAT(failure->message,
              HasSubstr("the servo loops do not come to rest before the clock starts; still moving: 'q'"));
  EXPECT_THAT(failure->message, HasSubstr("expected residuals that rise with the output of their amplifier"));
  EXPECT_THAT(
      failure->message,
      HasSubstr("remedy: check the signs at the amplifier's inputs, that its equation has a "
                "solution at the start, and its 'initial'; or let the run begin unsettled, with settle = "
                "false in [run]"));
  EXPECT_THAT(failure->message, ::testing::Not(HasSubstr("nor when all states on their loop move")));
}

TEST(Rest, RefusesATriangleThatCannotClose) {
  const Compiled made(R"toml(o  = { type = "constant", value = 0 }
qx = { type = "constant", value = 0.9 }
c  = { type = "dyad-rrr", px = "o", py = "o", qx = "qx", qy = "o", r1 = 0.4, r2 = 0.3 }
)toml");
  const auto failure = failure_of(made);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, SolveError::Kind::no_rest);
  EXPECT_THAT(failure->message, HasSubstr("'c.triangle.sine'"));
}

TEST(Rest, NamesTheGroupThatFailsNotThoseBeforeIt) {
  const Compiled made(R"toml(one = { type = "constant" }
good = { type = "divider", numerator = "one", denominator = "one" }
bad  = { type = "servo-amplifier", in = ["good", "-bad"] }
)toml");
  const auto failure = failure_of(made);
  ASSERT_TRUE(failure);
  EXPECT_THAT(failure->message, HasSubstr("still moving: 'bad' (at "));
  EXPECT_THAT(failure->message, ::testing::Not(HasSubstr("good")));
}

TEST(Rest, ReportsAnAlgebraicLoopThatFailsAtTheStart) {
  const Compiled made(R"toml(one = { type = "constant" }
s = { type = "summer", in = ["one", "s"] }
q = { type = "servo-amplifier", in = ["q", "-s"] }
)toml");
  const auto failure = failure_of(made);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, SolveError::Kind::singular_loop);
}

// Each divider has a negative denominator, so its loop runs away from the quotient. The determinant of two of
// them has the sign of a stable pair; the eigenvalues tell.
TEST(Rest, RefusesAnUnstablePairThatBalances) {
  const auto failure = failure_of(Compiled(R"toml(x = { type = "constant", value = -0.5 }
z = { type = "constant", value = 0.001 }
p = { type = "divider", numerator = "z", denominator = "x", initial = -0.002 }
q = { type = "divider", numerator = "z", denominator = "x", initial = -0.002 }
)toml"));
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, SolveError::Kind::no_rest);
  EXPECT_THAT(failure->message, HasSubstr("'p.quotient'"));
}

// Loops that close through states which are held before the clock starts.

/// a sees −a + w l − 0.01 and l follows it: alone a runs away, at 2π(100 − 1)/s.
std::string lagging(double weight, const char* lag) {
  return fmt::format(R"toml(u = {{ type = "constant", value = 0.01 }}
a = {{ type = "servo-amplifier", in = ["-a", "{}*l", "-u"], gain = 100, bandwidth = 1 }}
{})toml",
                     weight, lag);
}
constexpr const char* kLag = "l = { type = \"transfer-lag\", in = \"a\", time_constant = 0.001 }\n";
constexpr const char* kIntegrator = "l = { type = \"integrator\", in = [\"1000*a\", \"-1000*l\"] }\n";

TEST(Rest, StartsALoopUnsettledThatOnlyItsLagsHold) {
  for (const char* const lag : {kLag, kIntegrator}) {
    const auto result = testing::run_of(Compiled(lagging(2, lag)), {.until = 0.05, .samples = 51});
    // By the exponential of the 2×2 matrix, in SciPy; a hundred times the tolerance of the run
    const auto a = testing::row_values(result, "a");
    EXPECT_EQ(a[0], 0);
    EXPECT_NEAR(a[2], 0.01365046, 2e-8);
    EXPECT_NEAR(a[5], 0.01130030, 2e-8);
    EXPECT_NEAR(a[50], 0.00990094, 2e-8);
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_EQ(
        text::to_string(result.warnings[0]),
        "d.toml: the run does not start at rest: 'a' at 0 cannot settle before the clock starts, because its "
        "loop closes through 'l', which is held until then; the closed loop is stable, and the run begins "
        "with "
        "its transient\n  remedy: give the amplifier the 'initial' from which it is to start");
  }
}

TEST(Rest, SettlesTheOthersBesideALoopThatStartsUnsettled) {
  const auto result = testing::run_of(Compiled(lagging(2, kLag) + R"toml(one = { type = "constant" }
half = { type = "constant", value = 0.5 }
q = { type = "divider", numerator = "one", denominator = "half", gain = 1e6 }
)toml"),
                                      {.until = 1e-9, .samples = 2});
  EXPECT_NEAR(testing::row_values(result, "q").front(), 1 / (0.5 + 1e-6), 1e-12);
}

TEST(Rest, RefusesALoopThatItsLagsDoNotHoldEither) {
  const auto failure = failure_of(Compiled(lagging(0.5, kLag)));
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, SolveError::Kind::no_rest);
  EXPECT_THAT(failure->message,
              HasSubstr("the servo loops do not come to rest before the clock starts, nor when all "
                        "states on their loop move; still moving: 'a'"));
}

// What lies at its bend where the run starts, and leaves it upwards, is on the side to which it goes: the
// rest of a loop beside it has no other opinion. Truth: |t/2|, and √½ but for a gain of 1e6.
TEST(Rest, LeavesWhatStartsAtItsBendWhereItGoes) {
  for (const char* const bent :
       {"a = { type = \"absolute-value\", in = \"x\" }", "a = { type = \"diode\", in = \"x\" }",
        "a = { type = \"function-generator\", in = \"x\", points = [[-1, 1], [0, 0], [1, 1]] }"}) {
    const Compiled made(fmt::format(R"toml(
u = {{ type = "constant", value = 0.5 }}
x = {{ type = "integrator", in = "u" }}
{}
r = {{ type = "square-root", in = "u" }}
)toml",
                                    bent));
    const solve::Run run = testing::run_of(made, {.until = 1});
    EXPECT_NEAR(testing::row_values(run, "a").back(), 0.5, 1e-9) << bent;
    EXPECT_NEAR(testing::row_values(run, "r").back(), std::sqrt(0.5), 2e-6) << bent;
  }
}

// A state that is held while a loop settles may be as large as it likes.
TEST(Rest, IsFoundBesideWhatIsFarAway) {
  const Rested rested(R"toml(
x = { type = "integrator", in = "-x", initial = 1e9 }
u = { type = "constant", value = 0.5 }
r = { type = "square-root", in = "u" }
)toml");
  EXPECT_NEAR(rested.state("r.root"), std::sqrt(0.5), 2e-6);
}

// From where the amplifiers start, the way to where their sums are zero leads across what bends: |y| = 0.5
// from −0.4 over 0, a limiter from below to above, a table over three of its corners. On the side where they
// start they would run away. The static error is out/(μ ∂r/∂out), μ = 10⁶.
TEST(Rest, IsFoundBeyondWhatBends) {
  const auto run = testing::run_of(testing::Compiled(R"toml(half = { type = "constant", value = 0.5 }
magnitude = { type = "absolute-value", in = "y" }
y = { type = "servo-amplifier", in = ["magnitude", "-half"], initial = -0.4 }
limited = { type = "limiter", in = "z", low = -1, high = 0.2 }
z = { type = "servo-amplifier", in = ["limited", "0.1*z", "-half"], initial = -3 }
lines = { type = "function-generator", in = "w", points = [[-3, -1], [0, -1], [1, -0.5], [2, 0.5], [3, 0.4]] }
w = { type = "servo-amplifier", in = ["lines"], initial = -2 }
)toml"));
  EXPECT_NEAR(testing::row_values(run, "y").front(), 0.5, 1e-6);
  EXPECT_NEAR(testing::row_values(run, "z").front(), 3, 1e-4);
  EXPECT_NEAR(testing::row_values(run, "w").front(), 1.5, 1e-5);
}

// An amplifier is never beyond its limit: an `initial` of 25 is that limit, 1.2. From 25 the square of y,
// that is limited, too, led it to the other limit.
TEST(Rest, IsSoughtFromTheLimitWhereTheGuessLiesBeyond) {
  for (const double side : {1, -1}) {
    const auto run = testing::run_of(testing::Compiled(fmt::format(
        R"toml(u = {{ type = "constant", value = 0.25 }}
square = {{ type = "multiplier", in = ["y", "y"], limit = 1.2 }}
y = {{ type = "servo-amplifier", in = ["{0}*square", "{1}*u"], gain = 1e5, limit = 1.2, initial = {2} }}
)toml",
        side, -side, 25 * side)));
    EXPECT_NEAR(testing::row_values(run, "y").front(), 0.5 * side, 1e-5) << side;  // to the gain
  }
}

}  // namespace
}  // namespace oblique::solve
