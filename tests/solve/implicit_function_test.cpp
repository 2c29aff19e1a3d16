// SPDX-License-Identifier: MIT
// Equations that servo amplifiers solve, from the books on analog computing: roots, inverse functions,
// division, resolution, coupled equations. Each by a real amplifier, by one of infinite bandwidth, and by an
// ideal one.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

struct Circuit {
  const char* name;
  const char* blocks;  ///< '@' stands for the parameters of an amplifier
  const char* signal;
  double until;
  double truth;  ///< of the signal at the end
};

const double kSine3 = std::sin(3.0);

const Circuit kCircuits[] = {
    {"SquareRoot", R"toml(u = { type = "time-function", formula = "1 + 0.5*sin(time)" }
yy = { type = "squarer", in = "y" }
y = { type = "servo-amplifier", in = ["yy", "-u"] @ }
)toml",
     "y", 3, std::sqrt(1 + 0.5 * kSine3)},
    // the derivative 3 y² vanishes at t = π/2, where the root is of odd order and the amplifier goes through
    {"CubeRootThroughZero", R"toml(u = { type = "time-function", formula = "cos(time)" }
yy = { type = "squarer", in = "y" }
yyy = { type = "multiplier", in = ["yy", "y"] }
y = { type = "servo-amplifier", in = ["yyy", "-u"], initial = 1 @ }
z = { type = "integrator", in = "y" }
)toml",
     "y", 3, std::cbrt(std::cos(3.0))},
    {"ArcSine", R"toml(u = { type = "time-function", formula = "0.9*sin(time)" }
s = { type = "sine", in = "y" }
y = { type = "servo-amplifier", in = ["s", "-u"] @ }
)toml",
     "y", 5, std::asin(0.9 * std::sin(5.0))},
    // from far away, to a root at 0 where the exponential is 1 to rounding
    {"LogarithmFromTheExponential", R"toml(u = { type = "time-function", formula = "1 + time" }
e = { type = "exponential", in = "y" }
y = { type = "servo-amplifier", in = ["e", "-u"], initial = 3 @ }
)toml",
     "y", 6, std::log(7.0)},
    {"Division", R"toml(z = { type = "time-function", formula = "sin(time)" }
x = { type = "time-function", formula = "2 + cos(time)" }
xy = { type = "multiplier", in = ["x", "y"] }
y = { type = "servo-amplifier", in = ["xy", "-z"] @ }
)toml",
     "y", 3, kSine3 / (2 + std::cos(3.0))},
    // y e^y = 5 where y = W(5)
    {"LambertW", R"toml(u = { type = "time-function", formula = "time" }
e = { type = "exponential", in = "y" }
ye = { type = "multiplier", in = ["y", "e"] }
y = { type = "servo-amplifier", in = ["ye", "-u"] @ }
)toml",
     "y", 5, 1.3267246652422002},
    // E − 0.6 sin E = 6, by bisection
    {"KeplersEquation", R"toml(one = { type = "constant" }
m = { type = "integrator", in = "one" }
s = { type = "sine", in = "y" }
y = { type = "servo-amplifier", in = ["y", "-0.6*s", "-m"] @ }
)toml",
     "y", 6, 5.64029163687176},
    // a whole turn and more: the angle of (cos t, sin t)
    {"AngleOfAVector", R"toml(x = { type = "time-function", formula = "2*cos(time)" }
w = { type = "time-function", formula = "2*sin(time)" }
s = { type = "sine", in = "y" }
c = { type = "cosine", in = "y" }
xs = { type = "multiplier", in = ["x", "s"] }
wc = { type = "multiplier", in = ["w", "c"] }
y = { type = "servo-amplifier", in = ["xs", "-wc"] @ }
)toml",
     "y", 10, 10},
    // x + y = 3, x y = 2 + 0.1 sin t: of the two solutions the one that both amplifiers hold
    {"SumAndProduct", R"toml(s = { type = "constant", value = 3 }
p = { type = "time-function", formula = "2 + 0.1*sin(time)" }
xy = { type = "multiplier", in = ["x", "y"] }
x = { type = "servo-amplifier", in = ["3*x", "3*y", "-3*s"], initial = 0.7 @ }
y = { type = "servo-amplifier", in = ["-xy", "p"], initial = 2.2 @ }
)toml",
     "y", 3, (3 + std::sqrt(1 - 0.4 * kSine3)) / 2},
    // by Cramer's rule, with the determinant 16.25
    {"ThreeLinearEquations", R"toml(b1 = { type = "constant" }
b2 = { type = "time-function", formula = "sin(time)" }
b3 = { type = "constant", value = 2 }
x = { type = "servo-amplifier", in = ["4*x", "y", "0.5*z", "-b1"] @ }
y = { type = "servo-amplifier", in = ["x", "3*y", "-z", "-b2"] @ }
z = { type = "servo-amplifier", in = ["0.5*x", "-y", "2*z", "-b3"] @ }
)toml",
     "z", 2, (19.5 + 4.5 * std::sin(2.0)) / 16.25},
    // Two circles of radius 1 whose centres are d apart: x = d/2, y = √(1 − x²)
    {"TwoCircles", R"toml(d = { type = "time-function", formula = "1.2 + 0.2*sin(3*time)" }
one = { type = "constant" }
xx = { type = "squarer", in = "x" }
yy = { type = "squarer", in = "y" }
xd = { type = "summer", in = ["x", "-d"] }
xd2 = { type = "squarer", in = "xd" }
y = { type = "servo-amplifier", in = ["xx", "yy", "-one"], initial = 1 @ }
x = { type = "servo-amplifier", in = ["-xd2", "-yy", "one"], initial = 0.5 @ }
)toml",
     "y", 1, std::sqrt(1 - std::pow((1.2 + 0.2 * kSine3) / 2, 2))},
    // Colebrook: s = −2 lg(r/3.7 + 2.51 s/Re), r = 1e-3, Re = 1e5; by bisection
    {"FrictionOfAPipe", R"toml(r = { type = "constant", value = 2.7027027027027027e-4 }
in = { type = "summer", in = ["r", "2.51e-5*y"] }
ln = { type = "logarithm", in = "in" }
y = { type = "servo-amplifier", in = ["y", "0.8685889638065036*ln"], initial = 5 @ }
)toml",
     "y", 1, 6.715413045710710},
    // p + p³ + x = 0, x′ = p: p dt = −(1 + 3 p²) dp, so ln|p| + 3 p²/2 falls by t; solved for p
    {"ImplicitDerivative", R"toml(pp = { type = "squarer", in = "p" }
ppp = { type = "multiplier", in = ["pp", "p"] }
p = { type = "servo-amplifier", in = ["p", "ppp", "x"] @ }
x = { type = "integrator", in = "p", initial = 3 }
)toml",
     "x", 3, 0.496144373117303},
    // c² = 0.49 from between the roots: to the one where the residual rises
    {"RootFromTheOtherSide", R"toml(u = { type = "constant", value = 0.49 }
cc = { type = "squarer", in = "c" }
c = { type = "servo-amplifier", in = ["cc", "-u"], initial = -0.1 @ }
)toml",
     "c", 1, 0.7},
};

class ImplicitFunction : public ::testing::TestWithParam<Circuit> {};
INSTANTIATE_TEST_SUITE_P(Circuits, ImplicitFunction, ::testing::ValuesIn(kCircuits),
                         [](const auto& tested) { return tested.param.name; });

double end_of(const Circuit& circuit, const std::string& parameters) {
  std::string blocks = circuit.blocks;
  for (auto at = blocks.find('@'); at != std::string::npos; at = blocks.find('@'))
    blocks.replace(at, 1, parameters);
  const Run result = run_of(Compiled(blocks), {.until = circuit.until, .samples = 201});
  EXPECT_TRUE(result.warnings.empty()) << text::to_string(result.warnings.front());
  return row_values(result, circuit.signal).back();
}

TEST_P(ImplicitFunction, IsSolvedByEveryAmplifier) {
  const Circuit& circuit = GetParam();
  // ideal: to the solver's tolerance, where there are states, a hundred times
  EXPECT_NEAR(end_of(circuit, R"(, gain = inf, bandwidth = inf)"), circuit.truth, 1e-6);
  // the static error out/(μ ∂r/∂out), with derivatives of 0.1 and more
  EXPECT_NEAR(end_of(circuit, R"(, gain = 1e6, bandwidth = inf)"), circuit.truth, 1e-4);
  // and the lag of some 1/(2π 10 μ) s
  EXPECT_NEAR(end_of(circuit, ""), circuit.truth, 1e-4);
}

// Where sin y = u has no root any more an amplifier, ideal or real, goes to its limit, however near that is
// to the fold, and stays until u has fallen below sin(limit).
TEST(ImplicitFunction, EndsAtTheLimitBehindItsFold) {
  for (const char* const amplifier :
       {"gain = inf, bandwidth = inf", "gain = 1e6, bandwidth = inf", "gain = 1e8, bandwidth = 100"}) {
    for (const double limit : {1.572, 1.6, 2.0, 3.0}) {
      const Compiled made(fmt::format(R"toml(u = {{ type = "time-function", formula = "1.05*sin(2*time)" }}
s = {{ type = "sine", in = "y" }}
y = {{ type = "servo-amplifier", in = ["s", "-u"], {}, limit = {} }}
)toml",
                                      amplifier, limit));
      const auto result = run_of(made, {.until = 3.1, .samples = 311});
      const auto t = row_values(result, "t"), y = row_values(result, "y");
      const double fold = std::asin(1 / 1.05) / 2;
      const double leaves = (std::numbers::pi - std::asin(std::sin(limit) / 1.05)) / 2;
      for (std::size_t k = 0; k < t.size(); ++k) {
        const double part = std::fmod(t[k], std::numbers::pi / 2),
                     sign = t[k] < std::numbers::pi / 2 ? 1 : -1;
        if (std::abs(part - fold) < 0.02 || std::abs(part - leaves) < 0.001) continue;
        const double truth = part > fold && part < leaves ? limit : std::asin(1.05 * std::sin(2 * part));
        EXPECT_NEAR(y[k], sign * truth, 1e-4) << amplifier << ", " << limit << " at " << t[k];
      }
    }
  }
}

}  // namespace
}  // namespace oblique::solve
