// SPDX-License-Identifier: MIT
// Whole runs by Rodas5P: events, sources, loops, slides, saved states. Smooth problems are in
// catalogue_test.cpp.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::row_values;

RunOptions by_rodas(double until, double tolerance = 1e-8) {
  RunOptions options;
  options.until = until;
  options.tolerance = tolerance;
  options.method = diagram::IntegrationMethod::rodas;
  return options;
}

oblique::solve::Run run_by_rodas(const Compiled& made, double until, double tolerance = 1e-8) {
  return run(made.program, made.flat, by_rodas(until, tolerance));
}

TEST(Rodas, IsTakenWhereItIsAskedFor) {
  const auto result =
      run_by_rodas(Compiled("x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n"), 1);
  EXPECT_EQ(result.method.method, diagram::IntegrationMethod::rodas);
  EXPECT_EQ(result.method.reason, "as the diagram asks");
  EXPECT_NEAR(row_values(result, "x").back(), std::exp(-1), 1e-9);
  // a step: seven stages, the middle and the end of it; and one factorisation each
  const SolverStatistics& work = result.statistics;
  EXPECT_GE(work.evaluations, 9 * work.steps);
  EXPECT_EQ(work.factorizations, work.steps + work.error_test_failures);
  EXPECT_EQ(work.jacobians, work.steps);
}

// A ball falls from 1 at g = 2 and leaves the floor with 0.8 of its speed: it meets it at
// t_k = 1 + 2 (0.8 + … + 0.8^k), and between it is (t − t_k)(t_{k+1} − t) high. Times are right to the
// tolerance of the height over the speed, summed over the flights.
TEST(Rodas, FindsTheTimesOfABouncingBall) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("ball", R"toml(
[outputs]
height = { doc = "[machine unit]" }
speed = { doc = "[machine unit/s]" }
[equations]
"der(height)" = "speed"
"der(speed)" = "-2"
[start]
height = 1
speed = 0
[[events]]
when = "height < 0"
set = { speed = "-0.8*speed" }
)toml");
  const Compiled made("b = { type = \"ball\" }\n", "[outputs]\nheight = \"b.height\"\n", library);
  const auto result = run_by_rodas(made, 6);
  ASSERT_GT(result.events.size(), 3);
  double t = 1, flight = 2;
  std::vector<double> impacts;
  for (const EventRecord& event : result.events) {
    if (event.what != "b") continue;  // besides, its condition begins and ends
    EXPECT_NEAR(event.time, t, 1e-8) << event.what;
    impacts.push_back(t);
    flight *= 0.8;
    t += flight;
  }
  for (std::size_t row = 0; row < result.trajectory.rows(); ++row) {
    const double at = result.trajectory.at(row, 0);
    std::size_t k = 0;
    while (k < impacts.size() && impacts[k] <= at) ++k;
    if (k == 0 || k == impacts.size()) continue;
    EXPECT_NEAR(result.trajectory.at(row, 1), (at - impacts[k - 1]) * (impacts[k] - at), 1e-7) << at;
  }
}

// Laws of the time of very different speeds, each with a closed integral.
TEST(Rodas, FollowsWhatTheTimeAloneDoes) {
  const Compiled made(R"toml(
sine = { type = "sine-source", frequency = 8 }
a = { type = "integrator", in = ["sine"] }
r = { type = "ramp", slope = 3 }
b = { type = "integrator", in = ["r", "-b"] }
pulses = { type = "pulse-train", period = 0.5, width = 0.01 }
c = { type = "integrator", in = ["pulses"] }
late = { type = "step", at = 1.2345 }
d = { type = "integrator", in = ["1000*late", "-1000*d"] }
)toml");
  const auto result = run_by_rodas(made, 2);
  const std::vector<double> t = row_values(result, "t"), sine = row_values(result, "sine");
  const std::vector<double> a = row_values(result, "a"), b = row_values(result, "b"),
                            c = row_values(result, "c"), d = row_values(result, "d");
  for (std::size_t row = 0; row < t.size(); ++row) {
    EXPECT_NEAR(b[row], 3 * (t[row] - 1 + std::exp(-t[row])), 1e-8) << t[row];
    const double whole = std::floor(t[row] / 0.5 + 1e-12);
    EXPECT_NEAR(c[row], 0.01 * whole + std::min(0.01, t[row] - 0.5 * whole), 1e-8) << t[row];
    const double since = t[row] - 1.2345;
    EXPECT_NEAR(d[row], since > 0 ? 1 - std::exp(-1000 * since) : 0, 1e-8) << t[row];
  }
  const double w = 2 * std::numbers::pi * 8;
  for (std::size_t row = 0; row < t.size(); ++row)
    EXPECT_NEAR(a[row], (1 - std::cos(w * t[row])) / w, 1e-8) << t[row];
}

// A servo amplifier of gain 10⁶ that divides: q = cos t/(2 + sin t), to its static error of 10⁻⁶.
TEST(Rodas, RunsServoLoopsAndAlgebraicLoops) {
  for (const char* gain : {"1e6", "inf"}) {
    const Compiled made(fmt::format(R"toml(
c = {{ type = "integrator", in = ["-s"], initial = 1 }}
s = {{ type = "integrator", in = ["c"] }}
two = {{ type = "constant", value = 2 }}
divisor = {{ type = "summer", in = ["two", "s"] }}
p = {{ type = "multiplier", in = ["divisor", "q"] }}
q = {{ type = "servo-amplifier", in = ["p", "-c"], gain = {} }}
)toml",
                                    gain));
    const auto result = run_by_rodas(made, 10);
    const std::vector<double> t = row_values(result, "t"), q = row_values(result, "q");
    for (std::size_t row = 0; row < t.size(); ++row)
      EXPECT_NEAR(q[row], std::cos(t[row]) / (2 + std::sin(t[row])), 2e-6) << t[row];
    EXPECT_LT(result.statistics.steps, 1000);
  }
}

// x′ = −sgn x + 0.5 sin t reaches zero and stays there: on a slide the Jacobian is made by differences.
TEST(Rodas, SlidesAlongASwitchingSurface) {
  const Compiled made(R"toml(
c = { type = "integrator", in = ["-s"], initial = 1 }
s = { type = "integrator", in = ["c"] }
x = { type = "integrator", in = ["-sign", "0.5*s"], initial = 0.5 }
sign = { type = "sign", in = "x" }
y = { type = "integrator", in = ["sign"] }
)toml");
  const auto result = run_by_rodas(made, 10);
  const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x"),
                            y = row_values(result, "y");
  // before: x = 0.5 − t + 0.5 (1 − cos t), which is zero where t = 1 − cos(t)/2; then sgn x = sin(t)/2
  double meets = 0.6;
  for (int k = 0; k < 100; ++k) meets = 1 - std::cos(meets) / 2;
  for (std::size_t row = 0; row < t.size(); ++row) {
    if (t[row] < meets) continue;
    EXPECT_NEAR(x[row], 0, 1e-8) << t[row];
    EXPECT_NEAR(y[row], meets + (std::cos(meets) - std::cos(t[row])) / 2, 1e-7) << t[row];
  }
}

// An ideal rate limiter follows 0.5 sin t from 1, at 1 a second, meets it where 1 − t = 0.5 sin t, and slides
// on along it; and a point turns to the circle of radius 1, and round on it, a curved surface of two states.
// The way back to the surface, taken within its stages, once made the steps a thousand times as many.
TEST(Rodas, SlidesAlongWhatMovesAndBendsInLongSteps) {
  const Compiled moving(R"toml(u = { type = "sine-source", frequency = 0.15915494309189535, amplitude = 0.5 }
c = { type = "comparator", in = ["u", "-x"], low = -1, high = 1 }
x = { type = "integrator", in = ["c"], initial = 1 }
)toml");
  const auto followed = run_by_rodas(moving, 6);
  EXPECT_LT(followed.statistics.steps, 200);
  const auto t = row_values(followed, "t"), x = row_values(followed, "x");
  for (std::size_t r = 0; r < t.size(); ++r)
    EXPECT_NEAR(x[r], std::max(1 - t[r], std::sin(t[r]) / 2), 2e-8) << t[r];  // two tolerances
  const Compiled bent(R"toml(xx = { type = "squarer", in = "x" }
yy = { type = "squarer", in = "y" }
one = { type = "constant" }
c = { type = "comparator", in = ["one", "-xx", "-yy"], low = -1, high = 1 }
cx = { type = "multiplier", x = "c", y = "x" }
cy = { type = "multiplier", x = "c", y = "y" }
x = { type = "integrator", in = ["cx", "-y"], initial = 0.5 }
y = { type = "integrator", in = ["cy", "x"] }
)toml");
  const auto turned = run_by_rodas(bent, 20);
  EXPECT_LT(turned.statistics.steps, 400);
  const auto times = row_values(turned, "t"), rx = row_values(turned, "x"), ry = row_values(turned, "y");
  for (std::size_t r = 0; r < times.size(); ++r) {
    const double radius = std::min(1.0, 0.5 * std::exp(times[r]));  // r′ = r sign(1 − r²), and the angle is t
    EXPECT_NEAR(rx[r], radius * std::cos(times[r]), 1e-7) << times[r];  // of the 20 radians a tolerance each
    EXPECT_NEAR(ry[r], radius * std::sin(times[r]), 1e-7) << times[r];
  }
  // It is taken back: 3e-9 at a coarser tolerance, where 50 turns would else lead it off by 7e-8.
  const auto kept = run_by_rodas(bent, 300, 1e-6);
  const auto far_x = row_values(kept, "x"), far_y = row_values(kept, "y");
  EXPECT_NEAR(std::hypot(far_x.back(), far_y.back()), 1, 1e-8);
}

// What it saves goes on by any method, and what any saves by this: sin 20 all the same.
TEST(Rodas, GoesOnFromSavedStates) {
  const Compiled made(
      "c = { type = \"integrator\", in = [\"-s\"], initial = 1 }\n"
      "s = { type = \"integrator\", in = [\"c\"] }\n");
  using Method = diagram::IntegrationMethod;
  for (const auto& [first, second] : {std::pair(Method::rodas, Method::rodas),
                                      {Method::adams, Method::rodas},
                                      {Method::rodas, Method::bdf}}) {
    RunOptions options = by_rodas(7);
    options.method = first;
    RunOptions rest = by_rodas(20);
    rest.method = second;
    rest.from = run(made.program, made.flat, options).state;
    const auto result = run(made.program, made.flat, rest);
    // twenty radians by BDF leave 4e-8
    EXPECT_NEAR(row_values(result, "s").back(), std::sin(20.0), 1e-7);
  }
}

TEST(Rodas, StopsWhereItIsInterrupted) {
  const Compiled made(
      "c = { type = \"integrator\", in = [\"-s\"], initial = 1 }\n"
      "s = { type = \"integrator\", in = [\"c\"] }\n");
  RunOptions options = by_rodas(1e6);
  int asked = 0;
  options.interrupted = [&] { return ++asked > 5000; };
  const auto result = run(made.program, made.flat, options);
  EXPECT_GT(result.state.time, 1);
  EXPECT_LT(result.state.time, 1e4);
}

TEST(Rodas, RefusesSensitivities) {
  const Compiled made("x = { type = \"integrator\", in = [\"-x\"], initial = 1, rate = 2 }\n");
  RunOptions options = by_rodas(1);
  options.sensitivity = {"x.rate"};
  try {
    run(made.program, made.flat, options);
    FAIL();
  } catch (const text::ReadError& error) {
    EXPECT_STREQ(
        error.what(),
        "d.toml: sensitivities are integrated by CVODES, and the method is 'rodas'; expected 'auto', "
        "'bdf' or 'adams'\n  remedy: leave out method = \"rodas\" in [run]");
  }
}

// Near μ = 1000 the steps of a relaxation oscillation span ten powers of ten; truth: van der Pol 1000 of
// smooth_problems.py.
TEST(Rodas, TakesLongAndShortStepsByTurns) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("oscillator", R"toml(
[outputs]
x = { doc = "[machine unit]" }
v = { doc = "[machine unit]" }
[equations]
"der(x)" = "v"
"der(v)" = "1000*(1 - x^2)*v - x"
[start]
x = 2
v = 0
)toml");
  const Compiled made("o = { type = \"oscillator\" }\n", "[outputs]\nx = \"o.x\"\n", library);
  const auto result = run_by_rodas(made, 2000);
  EXPECT_NEAR(row_values(result, "x").back(), 1.706167732170483, 1e-8);
  EXPECT_LT(result.statistics.steps, 4000);
  EXPECT_THAT(result.warnings, IsEmpty());
}

// y follows 2 y³ − 0.52 y = 0.54 a until that folds, where it moves without bound. Truth: t over y by DOP853
// at 1e-13, as a function of which both are smooth; a is known to a tolerance of 1e-8 there, and moves by
// 0.27 a second. (Steps crept up to the fold that moved the states by less than rounding does, without end.)
TEST(Rodas, JumpsWhereABranchFolds) {
  const Compiled made(R"toml(
q = { type = "multiplier", x = "y", y = "y" }
c = { type = "multiplier", x = "q", y = "y" }
y = { type = "servo-amplifier", in = ["2*c", "-0.54*y", "-0.54*a"], gain = 50, bandwidth = inf, initial = 0.6 }
one = { type = "constant" }
other = { type = "integrator", in = ["-0.4*one"], initial = 0.589 }
a = { type = "integrator", in = ["0.335*b", "-1.076*y", "-0.95*a"], initial = -0.1826 }
b = { type = "integrator", in = ["-1.355*b"], initial = -0.4 }
)toml");
  RunOptions options = by_rodas(0.03);
  options.max_steps = 1000;  // takes 63
  const auto result = run(made.program, made.flat, options);
  ASSERT_EQ(result.events.size(), 1U);
  EXPECT_NEAR(result.events.front().time, 0.02110242136694, 1e-8 / 0.27);
  EXPECT_LT(row_values(result, "y").back(), -0.5);
}

}  // namespace
}  // namespace oblique::solve
