// SPDX-License-Identifier: MIT
// Division by implicit function: an amplifier of gain A drives q until x q − z = −q/A.
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kZ = 0.3;

/// A z/(1 + A x), in the form that also holds for A = inf.
double quotient(double gain, double x) {
  return kZ / (x + 1 / gain);
}

/// Gains up to infinity: below A x = 1 a loop broken by a delay would settle too, above it would not.
const std::vector<double> kGains{0.5, 1, 10, 1e4, 1e8, kInfinity};

//                 ┌───────────┐
//   x ──▶(×)──xq─▶│  A        ├──┬─▶ q         x sweeps from 0.2 to 2
//   ┌────▶    −z─▶│           │  │
//   │             └───────────┘  │
//   └────────────────────────────┘

class DivisionTest : public ::testing::TestWithParam<double> {};

TEST_P(DivisionTest, OfAnAlgebraicAmplifierIsExact) {
  const Compiled made(fmt::format(R"toml(one = {{ type = "constant" }}
z  = {{ type = "constant", value = 0.3 }}
x  = {{ type = "integrator", in = ["1.8*one"], initial = 0.2 }}
xq = {{ type = "multiplier", in = ["x", "q"] }}
q  = {{ type = "servo-amplifier", in = ["xq", "-z"], gain = {}, bandwidth = inf }}
)toml",
                                  GetParam()));
  const auto result = run_of(made, {.samples = 101});
  const auto x = row_values(result, "x"), q = row_values(result, "q");
  EXPECT_NEAR(x.back(), 2, 1e-12);  // a straight line: no truncation error, some roundings
  for (std::size_t r = 0; r < x.size(); ++r) {
    // The loop itself is one equation, solved to rounding, with the x of the same row.
    EXPECT_NEAR(q[r], quotient(GetParam(), x[r]), 1e-12) << r;
  }
}

// The same without any amplifier: q = A z − A x q, a summer in a ring with a multiplier.

class ExplicitDivisionTest : public ::testing::TestWithParam<double> {
 protected:
  /// Largest error of q; of the two blocks of the ring, the one that stands first is cut out and solved for.
  static double error(double gain, bool summer_first) {
    const std::string summer =
        fmt::format("q = {{ type = \"summer\", in = [\"{0}*z\", \"-{0}*xq\"] }}\n", gain);
    const std::string product = "xq = { type = \"multiplier\", in = [\"x\", \"q\"] }\n";
    const Compiled made((summer_first ? summer + product : product + summer) +
                        R"toml(one = { type = "constant" }
z = { type = "constant", value = 0.3 }
x = { type = "integrator", in = ["1.8*one"], initial = 0.2 }
)toml");
    EXPECT_EQ(made.program.loops().size(), 1U);
    const auto result = run_of(made, {.samples = 101});
    const auto x = row_values(result, "x"), q = row_values(result, "q");
    double largest = 0;
    for (std::size_t r = 0; r < x.size(); ++r)
      largest = std::max(largest, std::abs(q[r] - quotient(gain, x[r])));
    return largest;
  }
};

TEST_P(ExplicitDivisionTest, IsExactWhereTheSummerIsSolvedFor) {
  EXPECT_LT(error(GetParam(), true), 1e-12);
}

TEST_P(ExplicitDivisionTest, LosesTheDigitsOfTheGainWhereTheProductIsSolvedFor) {
  // q = A (z − x q) from an x q that is rounded: half an ulp of 0.3 or so, A times.
  EXPECT_LT(error(GetParam(), false), 1e-15 + GetParam() * std::numeric_limits<double>::epsilon());
}

INSTANTIATE_TEST_SUITE_P(Gains, ExplicitDivisionTest, ::testing::Values(0.5, 1, 10, 1e4, 1e8),
                         [](const auto& tested) { return "Gain" + std::to_string(tested.index); });

// A sweep that the quotient itself drives: x′ = q, so x² grows linearly; the loop enters the Jacobian.

TEST_P(DivisionTest, DrivesAnIntegrator) {
  const Compiled made(fmt::format(R"toml(z  = {{ type = "constant", value = 0.3 }}
x  = {{ type = "integrator", in = ["q"], initial = 0.2 }}
xq = {{ type = "multiplier", in = ["x", "q"] }}
q  = {{ type = "servo-amplifier", in = ["xq", "-z"], gain = {}, bandwidth = inf }}
)toml",
                                  GetParam()));
  const auto result = run_of(made, {.until = 4, .samples = 41});
  const auto t = row_values(result, "t"), x = row_values(result, "x");
  const double shift = 1 / GetParam();
  for (std::size_t r = 0; r < x.size(); ++r) {  // (x + 1/A) x′ = z
    const double exact = std::sqrt((0.2 + shift) * (0.2 + shift) + 2 * kZ * t[r]) - shift;
    EXPECT_NEAR(x[r], exact, 1e-6) << r;  // a hundred steps of tolerance 1e-8
  }
}

INSTANTIATE_TEST_SUITE_P(Gains, DivisionTest, ::testing::ValuesIn(kGains), [](const auto& tested) {
  return std::isinf(tested.param) ? std::string("Infinite") : "Gain" + std::to_string(tested.index);
});

/// Largest error of the shipped divider against z/x while x sweeps.
double divider_error(double gain, const std::string& bandwidth) {
  const Compiled made(fmt::format(R"toml(one = {{ type = "constant" }}
z = {{ type = "constant", value = 0.3 }}
x = {{ type = "integrator", in = ["0.5*one"], initial = 0.5 }}
d = {{ type = "divider", numerator = "z", denominator = "x", gain = {}, bandwidth = {} }}
)toml",
                                  gain, bandwidth));
  const auto result = run_of(made, {.tolerance = 1e-10, .samples = 51});
  const auto x = row_values(result, "x"), q = row_values(result, "d");
  double error = 0;
  for (std::size_t r = 0; r < x.size(); ++r) error = std::max(error, std::abs(q[r] - kZ / x[r]));
  return error;
}

TEST(Divider, ConvergesAsOneOverGain) {
  for (const char* bandwidth : {"inf", "\"10 Hz\""}) {
    double last = 0;
    for (const double gain : {1e3, 1e4, 1e5, 1e6}) {
      const double error = divider_error(gain, bandwidth);
      // The error is z/(A x²) (1 + O(1/(A x))): its order leaves −1 by less than 2/(A x) = 0.4 %.
      if (last > 0) {
        EXPECT_NEAR(std::log10(last / error), 1, 4e-3) << gain << ' ' << bandwidth;
      }
      last = error;
    }
    EXPECT_NEAR(last, kZ / 1e6 / 0.25, 1e-8);  // at x = 0.5
  }
}

TEST(Divider, IsExactWithAnIdealAmplifier) {
  EXPECT_LT(divider_error(kInfinity, "inf"), 1e-15);
  EXPECT_LT(divider_error(kInfinity, "\"10 Hz\""), 1e-15);
}

}  // namespace
}  // namespace oblique::solve
