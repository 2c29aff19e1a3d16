// SPDX-License-Identifier: MIT
// States that grow from below the absolute tolerance.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using testing::row_values;
using testing::run_of;

constexpr diagram::IntegrationMethod kMethods[] = {
    diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf, diagram::IntegrationMethod::rodas};

std::string logistic(const std::string& start) {
  return "xx = { type = \"squarer\", in = \"x\" }\n"
         "x = { type = \"integrator\", in = [\"x\", \"-xx\"], initial = " +
         start + " }\n";
}

// x′ = x − x²: x = 1/(1 + (1/x₀ − 1) e^−t). The tolerance of the run is 1e-8, that of x in the solver 1e-12:
// from 1e-9 on only three digits of x are known without a second try, and the time at which it has grown up
// is off by so much.
TEST(UnseenGrowth, IsSeenBySecondTry) {
  for (const char* const start : {"1e-5", "1e-9", "1e-11", "1e-20", "1e-100", "-1e-200"}) {
    const double first = std::stod(start);
    const double until = first < 0 ? 400 : std::log(1 / first) + 10;
    const oblique::solve::Run result = run_of(Compiled(logistic(start)), {.until = until});
    EXPECT_TRUE(result.warnings.empty()) << start;
    const auto t = row_values(result, "t"), x = row_values(result, "x");
    for (std::size_t k = 0; k < t.size(); ++k)
      EXPECT_NEAR(x[k], 1 / (1 + (1 / first - 1) * std::exp(-t[k])), 1e-7) << start << " at " << t[k];
  }
}

// Hopf's normal form from (a, 0): r′ = r − r³, the angle is 2t. The absolute errors of the first e² of the
// growth would move the time of the rest of it by up to 13 000 tolerances at a = 1e-7, and by 240 at 1e-5;
// from 1e-4 on they are left, and are up to 90 of them.
TEST(UnseenGrowth, IsSeenFromWhereAbsoluteErrorsDecide) {
  for (const double a : {1e-7, 1e-6, 1e-5, 1e-4}) {
    const Compiled made(fmt::format(R"(
xx = {{ type = "squarer", in = "x" }}
yy = {{ type = "squarer", in = "y" }}
g = {{ type = "summer", in = ["one", "-xx", "-yy"] }}
one = {{ type = "constant" }}
gx = {{ type = "multiplier", in = ["g", "x"] }}
gy = {{ type = "multiplier", in = ["g", "y"] }}
x = {{ type = "integrator", in = ["gx", "-2*y"], initial = {} }}
y = {{ type = "integrator", in = ["gy", "2*x"] }}
)",
                                    a));
    for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                              diagram::IntegrationMethod::rodas}) {
      for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
        const oblique::solve::Run run = run_of(made, {.until = 41, .tolerance = tolerance, .method = method});
        EXPECT_TRUE(run.warnings.empty());
        const auto t = row_values(run, "t"), x = row_values(run, "x");
        for (std::size_t k = 0; k < t.size(); ++k) {
          const double r = 1 / std::sqrt(1 + (1 / (a * a) - 1) * std::exp(-2 * t[k]));
          ASSERT_NEAR(x[k], r * std::cos(2 * t[k]), 100 * tolerance) << a << ' ' << static_cast<int>(method);
        }
      }
    }
  }
}

// Autocatalysis, a′ = −ab, b′ = ab from (1, b₀): b is a logistic. What b grows by is a state of the size of
// one that acts back on it, and moves as little. Some 5000 tolerances where that hides it.
TEST(UnseenGrowth, IsSeenBesideALargeState) {
  for (const double b0 : {1e-7, 1e-6, 1e-5}) {
    const Compiled made(fmt::format(R"(
ab = {{ type = "multiplier", in = ["a", "b"] }}
a = {{ type = "integrator", in = ["-ab"], initial = 1 }}
b = {{ type = "integrator", in = ["ab"], initial = {} }}
)",
                                    b0));
    for (const auto method : kMethods) {
      for (const double tolerance : {1e-4, 1e-8}) {
        const oblique::solve::Run run = run_of(made, {.until = 30, .tolerance = tolerance, .method = method});
        const auto t = row_values(run, "t"), b = row_values(run, "b");
        for (std::size_t k = 0; k < t.size(); ++k)
          ASSERT_NEAR(b[k], (1 + b0) / (1 + std::exp(-(1 + b0) * t[k]) / b0), 100 * tolerance) << b0;
      }
    }
  }
}

// Hopf's normal form that turns with 100 rad/s, thirty times while it grows by e²: 50 000 tolerances
// otherwise.
TEST(UnseenGrowth, IsSeenInAFastOscillation) {
  const Compiled made(R"(
xx = { type = "squarer", in = "x" }
yy = { type = "squarer", in = "y" }
g = { type = "summer", in = ["one", "-xx", "-yy"] }
one = { type = "constant" }
gx = { type = "multiplier", in = ["g", "x"] }
gy = { type = "multiplier", in = ["g", "y"] }
x = { type = "integrator", in = ["gx", "-100*y"], initial = 1e-6 }
y = { type = "integrator", in = ["gy", "100*x"] }
)");
  const oblique::solve::Run run = run_of(made, {.until = 20, .tolerance = 1e-8});
  const auto t = row_values(run, "t"), x = row_values(run, "x");
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double r = 1 / std::sqrt(1 + (1e12 - 1) * std::exp(-2 * t[k]));
    ASSERT_NEAR(x[k], r * std::cos(100 * t[k]), 1e-6);  // 100 tolerances
  }
}

// A swing, x″ = −(1 + 0.8 cos 2t) x: at nearly all instants no mode grows, and yet x does from turn to turn.
// It is linear: from 1 it is the same, times 1e9. Half a million tolerances otherwise.
TEST(UnseenGrowth, IsSeenWhereNoModeGrows) {
  const auto swing = [](double start) {
    return Compiled(fmt::format(R"toml(
k = {{ type = "time-function", formula = "1 + 0.8*cos(2*time)" }}
kx = {{ type = "multiplier", in = ["k", "x"] }}
v = {{ type = "integrator", in = ["-kx"] }}
x = {{ type = "integrator", in = ["v"], initial = {} }}
)toml",
                                start));
  };
  const auto truth = row_values(run_of(swing(1), {.until = 103.6, .tolerance = 1e-12}), "x");
  for (const auto method : kMethods) {
    for (const double tolerance : {1e-6, 1e-8}) {
      const auto x =
          row_values(run_of(swing(1e-9), {.until = 103.6, .tolerance = tolerance, .method = method}), "x");
      for (std::size_t k = 0; k < x.size(); ++k) ASSERT_NEAR(x[k], 1e-9 * truth[k], 100 * tolerance);
    }
  }
}

// x′ = (t − a) x falls from 1 to exp(−a²/2) and is 1 again at t = 2a. Half of the first part is lost where
// its absolute errors are not seen, and 300 tolerances by BDF at 1e-3 where growth is looked at by steps
// alone.
TEST(UnseenGrowth, IsSeenBehindADecay) {
  for (const double a : {5.0, 5.5}) {
    const Compiled made(fmt::format(R"(
a = {{ type = "time-function", formula = "time - {}" }}
ax = {{ type = "multiplier", in = ["a", "x"] }}
x = {{ type = "integrator", in = "ax", initial = 1 }}
)",
                                    a));
    for (const auto method : kMethods) {
      for (const double tolerance : {1e-3, 1e-5, 1e-8})
        EXPECT_NEAR(
            row_values(run_of(made, {.until = 2 * a, .tolerance = tolerance, .method = method}), "x").back(),
            1, 30 * tolerance)  // of hundred that a run may err by; 23 at most
            << a << ' ' << tolerance << ' ' << static_cast<int>(method);
    }
  }
}

// A laser whose losses p′ = 20 (n − 5) p are let down to 1 after a minute: p has fallen to e^(−5000), which
// no number holds, and does not come back for hundreds of seconds. What it leaves in a run is its tolerance,
// and where that comes back n is half of 2 (1 − e^(−t/20)).
TEST(UnseenGrowth, IsSeenBehindADecayBelowAllNumbers) {
  const Compiled made(R"(
one = { type = "constant" }
losses = { type = "step", at = 60, from = 5, to = 1 }
n = { type = "integrator", in = ["0.1*one", "-0.05*n", "-np"] }
np = { type = "multiplier", in = ["n", "p"] }
lp = { type = "multiplier", in = ["losses", "p"] }
p = { type = "integrator", in = ["20*np", "-20*lp"], initial = 1e-5 }
)");
  for (const auto method : kMethods) {
    for (const double tolerance : {1e-4, 1e-6, 1e-10}) {
      const auto run = run_of(made, {.until = 75, .tolerance = tolerance, .method = method});
      EXPECT_NEAR(row_values(run, "n").back(), 2 * (1 - std::exp(-75 / 20.)), 2 * tolerance)
          << tolerance << ' ' << static_cast<int>(method);
    }
  }
}

// As a logistic about 1/2: x′ = (x − 1/2)(3/2 − x) from 1/2 + d. Here the relative tolerance hides the
// distance: by 5500 tolerances at d = 1e-5. A finer run needs no more of it than is left for d, and at 1e-11
// there is not so much.
TEST(UnseenGrowth, IsSeenBesideAnEquilibriumThatIsNotZero) {
  const auto shifted = [](double d) {
    return Compiled(fmt::format(R"(
half = {{ type = "constant", value = 0.5 }}
a = {{ type = "summer", in = ["x", "-half"] }}
b = {{ type = "summer", in = ["3*half", "-x"] }}
ab = {{ type = "multiplier", in = ["a", "b"] }}
x = {{ type = "integrator", in = ["ab"], initial = {} }}
)",
                                0.5 + d));
  };
  for (const double d : {1e-6, 1e-5, 1e-4, 1e-3}) {
    const Compiled made = shifted(d);
    const double from = 0.5 + d - 0.5;  // as the machine number has it
    for (const auto method : kMethods) {
      for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
        const oblique::solve::Run run = run_of(made, {.until = 30, .tolerance = tolerance, .method = method});
        EXPECT_TRUE(run.warnings.empty()) << d << ' ' << tolerance;
        const auto t = row_values(run, "t"), x = row_values(run, "x");
        for (std::size_t k = 0; k < t.size(); ++k)
          ASSERT_NEAR(x[k], 0.5 + 1 / (1 + (1 / from - 1) * std::exp(-t[k])), 100 * tolerance)
              << d << ' ' << tolerance << ' ' << static_cast<int>(method);
      }
    }
  }
  EXPECT_EQ(run_of(shifted(1e-11), {.until = 40, .tolerance = 1e-8}).warnings.size(), 1U);
}

// Which takes more steps, and is told of where there are not so many.
TEST(UnseenGrowth, IsToldWhereTheSecondTryTakesTooManySteps) {
  const oblique::solve::Run result = run_of(Compiled(logistic("1e-20")), {.until = 60, .max_steps = 500});
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_THAT(
      result.warnings[0].what,
      HasSubstr("unstable equilibrium: too near for its tolerance, and a finer run takes too many steps, so "
                "that what follows may be wrong"));
  EXPECT_EQ(result.warnings[0].remedy,
            "raise max_steps in [run], or start farther from the equilibrium, or write the states as their "
            "distance "
            "from it");
}

TEST(UnseenGrowth, LeavesAnEquilibriumThatIsMetExactly) {
  const oblique::solve::Run result = run_of(Compiled(logistic("0")), {.until = 100});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_EQ(row_values(result, "x").back(), 0);
  EXPECT_LT(result.statistics.steps, 10);
}

// A mass on a spring and a belt, whose friction falls with the sliding speed: while it sticks, its speed is
// held on the switching surface, and what would grow at constant shares of the two sides does not. Nothing is
// uncertain in it. The truth by an explicit method of order 8 from stick to slip (SciPy's DOP853 at 1e-13).
TEST(UnseenGrowth, IsNotWhatASlideHolds) {
  const oblique::solve::Run result = run_of(Compiled(R"(
x = { type = "integrator", in = "v" }
v = { type = "integrator", in = ["-x", "-f"] }
belt = { type = "constant", value = 0.2 }
r = { type = "summer", in = ["v", "-belt"] }
s = { type = "sign", in = "r" }
a = { type = "absolute-value", in = "r" }
e = { type = "exponential", in = "-5*a" }
one = { type = "constant" }
m = { type = "summer", in = ["0.5*one", "0.5*e"] }
f = { type = "multiplier", in = ["s", "m"] }
)"),
                                            {.until = 40});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_NEAR(row_values(result, "x").back(), 0.1624416511, 1e-6);  // a hundred tolerances
}

// A Schmitt trigger leaves its limit where u falls below −1/2, exactly from its equilibrium; but u goes on,
// and drives it to the other limit within a nanosecond: no error decides where it goes, nor when.
TEST(UnseenGrowth, IsNotWhatTheTimeDrives) {
  const auto result = run_of(Compiled(R"toml(u = { type = "time-function", formula = "1.05*sin(2*time)" }
y = { type = "servo-amplifier", in = ["-u", "-0.5*y"], gain = 1e6, bandwidth = 1000, limit = 1, initial = 1 }
)toml"),
                             {.until = 3, .samples = 301});
  EXPECT_TRUE(result.warnings.empty());
  const double turns = (std::numbers::pi + std::asin(0.5 / 1.05)) / 2;
  const auto t = row_values(result, "t"), y = row_values(result, "y");
  for (std::size_t k = 0; k < t.size(); ++k) EXPECT_NEAR(y[k], t[k] < turns ? 1 : -1, 1e-7) << t[k];
}

// x′ = x − 1 − A sin 10t from 1: x stands still at times, but what drives it moves the place at which it
// would stay by far more than its errors.
TEST(UnseenGrowth, IsNotWhatOtherStatesDrive) {
  const Compiled made(R"(one = { type = "constant" }
s = { type = "integrator", in = "10*v" }
v = { type = "integrator", in = "-10*s", initial = 0.001 }
x = { type = "integrator", in = ["x", "-one", "-s"], initial = 1 }
)");
  for (const auto method : kMethods) {
    RunOptions options;
    options.until = 4;
    options.method = method;
    int restarts = 0;
    options.on_restart = [&] { ++restarts; };
    const oblique::solve::Run result = run(made.program, made.flat, options);
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_EQ(restarts, 0) << static_cast<int>(method);
    const double ends = 1 + 1e-3 * (std::sin(40) + 10 * (std::cos(40) - std::exp(4.0))) / 101;
    EXPECT_NEAR(row_values(result, "x").back(), ends, 1e-8);  // the tolerance
  }
}

// Steps that were short for its growth become long again once it stands at its limit, where nothing asks for
// the Jacobian any more: 1500 in all, and not 10⁷.
TEST(UnseenGrowth, KeepsNoStepsShortThatHasEnded) {
  const Compiled made(R"toml(u = { type = "time-function", formula = "sin(6*time)" }
a = { type = "servo-amplifier", in = ["-u", "-0.5*a"], limit = 0.6, gain = 100, bandwidth = 1000, initial = 1 }
)toml");
  using diagram::IntegrationMethod;
  for (const auto method : {IntegrationMethod::bdf, IntegrationMethod::adams, IntegrationMethod::rodas})
    EXPECT_EQ(row_values(run_of(made, {.until = 10, .max_steps = 10'000, .method = method}), "a").back(),
              -0.6);
}

// Nor beside an integrator that stands at its own limit, and whose shares the Jacobian does not have: a turns
// over where u passes ±1/2, to within 1e-5, first at t₁ = π/6.
TEST(UnseenGrowth, IsNotOutrunBesideASlide) {
  const Compiled made(R"toml(u = { type = "time-function", formula = "sin(time)" }
a = { type = "servo-amplifier", in = ["-u", "-0.5*a"], gain = 1e5, bandwidth = "1 MHz", limit = 1, initial = -1 }
one = { type = "constant" }
drawn = { type = "summer", in = ["one", "0.1*a"] }
z = { type = "integrator", in = ["drawn"], limit = 0.2 }
y = { type = "integrator", in = ["a"] }
)toml");
  using diagram::IntegrationMethod;
  for (const auto method : {IntegrationMethod::bdf, IntegrationMethod::adams}) {
    for (const double tolerance : {1e-5, 1e-7}) {
      const auto result =
          run_of(made, {.until = 10, .tolerance = tolerance, .samples = 11, .method = method});
      EXPECT_NEAR(row_values(result, "z").back(), 0.2, 1e-9);
      // −1 up to t₁, +1, −1 and +1 for π each, and −1 again
      EXPECT_NEAR(row_values(result, "y").back(), 4 * std::numbers::pi - 10, 2 * tolerance);
    }
  }
}

// And an astable, whose lag moves all the time, leaves its limits at ±1/2: x = 1.1 e^−t − 1 up to ln 2.2 s.
TEST(UnseenGrowth, IsNotOfAnAmplifierThatALagDrives) {
  const auto result =
      run_of(Compiled(R"toml(x = { type = "transfer-lag", in = "a", time_constant = 1, initial = 0.1 }
a = { type = "servo-amplifier", in = ["x", "-0.5*a"], gain = 1e5, bandwidth = "1 kHz", limit = 1 }
)toml"),
             {.until = 1.5, .samples = 16});
  EXPECT_TRUE(result.warnings.empty());
  const double turned = std::log(2.2);
  const auto t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t k = 0; k < t.size(); ++k)  // a gain of 1e5 turns over at (1/2 − 1e-5)
    EXPECT_NEAR(x[k], t[k] < turned ? 1.1 * std::exp(-t[k]) - 1 : 1 - 1.5 * std::exp(turned - t[k]), 5e-5);
}

// y = arcsin u by an amplifier that stands at its limit of 2 behind the fold: where it leaves that, at u =
// sin 2, implicit steps longer than the 1e-9 s of its growth would lead it along π − arcsin u, beyond its
// limit, to any tolerance above the 1e-9 that it begins from.
TEST(UnseenGrowth, IsNotOutrunByImplicitSteps) {
  const Compiled made(R"toml(u = { type = "time-function", formula = "1.05*sin(2*time)" }
s = { type = "sine", in = "y" }
y = { type = "servo-amplifier", in = ["s", "-u"], gain = 1e6, bandwidth = 1000, limit = 2 }
)toml");
  using diagram::IntegrationMethod;
  for (const auto method : {IntegrationMethod::bdf, IntegrationMethod::rodas}) {
    for (const double tolerance : {1e-4, 1e-6}) {
      const auto result =
          run_of(made, {.until = 1.9, .tolerance = tolerance, .samples = 191, .method = method});
      if (method == IntegrationMethod::bdf) {
        EXPECT_TRUE(result.warnings.empty()) << tolerance;
      }
      const double fold = std::asin(1 / 1.05) / 2,
                   leaves = (std::numbers::pi - std::asin(std::sin(2) / 1.05)) / 2;
      const auto t = row_values(result, "t"), y = row_values(result, "y");
      for (std::size_t k = 0; k < t.size(); ++k) {
        if (std::abs(t[k] - fold) < 0.02) continue;  // errors grow there as the root of the distance falls
        const double truth = t[k] > fold && t[k] < leaves ? 2 : std::asin(1.05 * std::sin(2 * t[k]));
        EXPECT_NEAR(y[k], truth, 10 * tolerance) << diagram::method_name(method) << " at " << t[k];
      }
    }
  }
}

// x″ = x from x = 0, x′ = 1e-11: neither state grows alone. x = 1e-11 sinh t.
TEST(UnseenGrowth, IsSeenInPairs) {
  const oblique::solve::Run result =
      run_of(Compiled("x = { type = \"integrator\", in = [\"y\"] }\n"
                      "y = { type = \"integrator\", in = [\"x\"], initial = 1e-11 }\n"),
             {.until = 25});
  EXPECT_TRUE(result.warnings.empty());
  const double end = 1e-11 * std::sinh(25.0);
  EXPECT_NEAR(row_values(result, "x").back(), end, 1e-7 * end);
}

// x′ = −a cos(ω t) x: x = exp(−(a/ω) sin ω t) falls to 3e-17, far below the tolerance, and comes back to 1.
TEST(UnseenGrowth, IsSeenWhereAStateFellBelowTheToleranceDuringTheRun) {
  const oblique::solve::Run result =
      run_of(Compiled(R"toml(a = { type = "time-function", formula = "-cos(2*pi*time/60)*4" }
ax = { type = "multiplier", in = ["a", "x"] }
x = { type = "integrator", in = ["ax"], initial = 1 }
)toml"),
             {.until = 45});
  EXPECT_TRUE(result.warnings.empty());
  const auto t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double truth = std::exp(-120 / std::numbers::pi * std::sin(2 * std::numbers::pi * t[k] / 60));
    EXPECT_NEAR(x[k], truth, 1e-6 * std::max(truth, 1.0)) << t[k];
  }
}

// Prey and predators (x′ = x − x y, y′ = x y − y from 20, 20) fall to 4.6e-15 in turn. Truth: SciPy's DOP853
// at 1e-13 on the logarithms of both, 5e-9 of it from one tolerance to the other. Without a second try x
// turns negative, and the run ends at −4e11.
TEST(UnseenGrowth, IsSeenWhereStatesFallInTurn) {
  const oblique::solve::Run result = run_of(Compiled(R"toml(xy = { type = "multiplier", in = ["x", "y"] }
x = { type = "integrator", in = ["x", "-xy"], initial = 20 }
y = { type = "integrator", in = ["-y", "xy"], initial = 20 }
)toml"),
                                            {.until = 60, .samples = 61});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_NEAR(row_values(result, "x").back() / 4.61143821e-09, 1, 1e-6);
  EXPECT_NEAR(row_values(result, "y").back() / 3.68505932e-07, 1, 1e-6);
}

// The same equation about 1: what a double keeps of 1e-11 beside 1 is five digits, which is not 1e-8.
TEST(UnseenGrowth, IsToldWhereNoToleranceSeesIt) {
  int restarts = 0, rows = 0;
  const Compiled made(R"toml(one = { type = "constant" }
e = { type = "summer", in = ["x", "-one"] }
ee = { type = "squarer", in = "e" }
x = { type = "integrator", in = ["e", "-ee"], initial = 1.00000000001 }
)toml");
  RunOptions options;
  options.until = 30;
  options.samples = 11;
  options.on_sample = [&](double, std::span<const double>, std::span<const double>) { ++rows; };
  options.on_restart = [&] {
    ++restarts;
    rows = 0;
  };
  const oblique::solve::Run result = run(made.program, made.flat, options);
  ASSERT_EQ(result.warnings.size(), 1);
  const std::string text = text::to_string(result.warnings.front());
  EXPECT_THAT(text, HasSubstr("d.toml: 'x' grew until t = "));
  EXPECT_THAT(text,
              HasSubstr("machine units of an unstable equilibrium: too near for the finest tolerance, so "
                        "that what follows may be wrong\n  remedy: start farther from the equilibrium, or "
                        "write the states as their distance from it"));
  EXPECT_GE(restarts, 1);
  EXPECT_EQ(rows, 11);
  const double seed = 1.00000000001 - 1;  // as a double keeps it
  EXPECT_NEAR(row_values(result, "x").back(), 1 + 1 / (1 + (1 / seed - 1) * std::exp(-30.0)), 1e-4);
}

// Nothing grows unseen in oscillations, decays and chaos: one run each.
TEST(UnseenGrowth, IsNotSuspectedElsewhere) {
  for (const char* const blocks :
       {"x = { type = \"integrator\", in = [\"-y\"], initial = 1 }\ny = { type = \"integrator\", in = "
        "[\"x\"] }\n",
        "x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n",
        "one = { type = \"constant\" }\nx = { type = \"integrator\", in = [\"one\"] }\n",
        "x = { type = \"integrator\", in = [\"10*y\", \"-10*x\"], initial = 1 }\n"
        "xz = { type = \"multiplier\", in = [\"x\", \"z\"] }\nxy = { type = \"multiplier\", in = [\"x\", "
        "\"y\"] }\n"
        "y = { type = \"integrator\", in = [\"28*x\", \"-xz\", \"-y\"], initial = 1 }\n"
        "z = { type = \"integrator\", in = [\"xy\", \"-2.6*z\"], initial = 1 }\n"}) {
    const Compiled made(blocks);
    RunOptions options;
    options.until = 30;
    int restarts = 0;
    options.on_restart = [&] { ++restarts; };
    EXPECT_TRUE(run(made.program, made.flat, options).warnings.empty());
    EXPECT_EQ(restarts, 0) << blocks;
  }
}

// x = a cos t, read by a gain of 1/a. The tolerance of x in the solver is 1e-12.
std::string small_oscillator(const std::string& size, const std::string& gain) {
  return "v = { type = \"integrator\", in = \"-x\" }\n"
         "x = { type = \"integrator\", in = \"v\", initial = " +
         size + " }\ny = { type = \"gain\", in = \"x\", factor = " + gain + " }\n";
}
constexpr const char* kShowY = "[outputs]\ny = \"y\"\n";

TEST(SmallStates, AreKnownWhereAnOutputShowsThem) {
  for (const int digits : {6, 9, 12, 15, 40, 200}) {
    const std::string power = std::to_string(digits);
    const oblique::solve::Run result =
        run_of(Compiled(small_oscillator("1e-" + power, "1e" + power), kShowY), {.until = 30});
    EXPECT_TRUE(result.warnings.empty()) << digits;
    const auto t = row_values(result, "t"), y = row_values(result, "y");
    // The tolerance of the run times the turns it goes on for.
    for (std::size_t k = 0; k < t.size(); ++k)
      EXPECT_NEAR(y[k], std::cos(t[k]), 1e-7) << digits << " at " << t[k];
  }
}

// Metres beside metres a second: x = a cos ωt with a = 5e-6 beside v = x′ of 0.5, is known beside its own
// size, to the tolerance of the run: four times worse without an absolute tolerance of its own.
TEST(SmallStates, AreKnownWhereAnOutputStandsInSmallUnits) {
  const oblique::solve::Run result =
      run_of(Compiled("v = { type = \"integrator\", in = \"-1e10*x\" }\n"
                      "x = { type = \"integrator\", in = \"v\", initial = 5e-6 }\n",
                      "[outputs]\nx = \"x\"\n"),
             {.until = 2e-4});
  const auto t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_NEAR(x[k], 5e-6 * std::cos(1e5 * t[k]), 5e-6 * 1e-8) << t[k];
}

// d, the integral of sin t − sin t, the one of the time and the other of states, shows their errors and
// nothing else: nothing would make it known, and no finer run is made.
TEST(SmallStates, AreNotWhatIsLeftOfLargerOnes) {
  const std::string oscillator =
      "c = { type = \"integrator\", in = \"-s\", initial = 1 }\ns = { type = \"integrator\", in = \"c\" }\n"
      "u = { type = \"time-function\", formula = \"sin(time)\" }\n";
  const oblique::solve::Run alone = run_of(Compiled(oscillator), {.until = 30});
  const oblique::solve::Run both =
      run_of(Compiled(oscillator + "d = { type = \"integrator\", in = [\"u\", \"-s\"] }\n"), {.until = 30});
  EXPECT_TRUE(both.warnings.empty());
  EXPECT_LT(both.statistics.steps, 2 * alone.statistics.steps);
}

TEST(SmallStates, AreLeftAloneWhereNothingShowsThem) {
  const oblique::solve::Run shown = run_of(Compiled(small_oscillator("1e-15", "1"), kShowY), {.until = 30});
  EXPECT_TRUE(shown.warnings.empty());
  EXPECT_LT(shown.statistics.steps, 50);
}

// A mean of a comparator that a state of 1e-11 turns over, one that the absolute tolerance hides.
TEST(SmallStates, AreKnownWhereAComparisonDependsOnThem) {
  const Compiled made(
      small_oscillator("1e-11", "1") +
      "c = { type = \"comparator\", in = \"x\" }\ni = { type = \"integrator\", in = \"c\" }\n");
  const oblique::solve::Run result = run_of(made, {.until = 4 * std::numbers::pi});
  // High for half of each turn. A comparison of states is met to 1e-13, one percent of a radian here.
  EXPECT_NEAR(row_values(result, "i").back(), 2 * std::numbers::pi, 4e-2);
}

TEST(SmallStates, AreToldOfWhereNoToleranceIsFineEnough) {
  const oblique::solve::Run result =
      run_of(Compiled(small_oscillator("1e-295", "1e295"), kShowY), {.until = 30});
  ASSERT_EQ(result.warnings.size(), 2U);
  EXPECT_EQ(
      result.warnings[1].what,
      "'x' stays within 1e-295 machine units, which is too small for the finest tolerance, and output 'y' "
      "depends on it: it may be wrong");
  EXPECT_EQ(result.warnings[1].remedy, "scale the state up, and down again what reads it");
}

}  // namespace
}  // namespace oblique::solve
