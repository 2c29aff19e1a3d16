// SPDX-License-Identifier: MIT
// Many switches at which the equations only bend, on their switching surfaces at one instant: wherever they
// stand there, the solution is the same.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "../support/chain.h"
#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::chain;
using testing::Compiled;
using testing::kOwnMagnitude;
using testing::row_values;
using testing::run_of;
using testing::shipped_blocks_and;

/// The error of u = sin t that the tolerance 1e-8 leaves over a turn, with a margin of ten.
constexpr double kError = 1e-7;

/// The chain by hand.
template <class Element>
double chained(double u, int n, double shift, const Element& element) {
  for (int k = 0; k < n; ++k) u = element(u - shift);
  return u;
}

/// The trapezoidal rule from 0 to t: 1e5 panels leave (7/1e5)²/12 · 7 · |bends| < 1e-8.
template <class Element>
double integral(double t, int n, double shift, const Element& element) {
  constexpr int kPanels = 100'000;
  double sum = 0;
  for (int k = 0; k <= kPanels; ++k) {
    const double value = chained(std::sin(t * k / kPanels), n, shift, element);
    sum += (k == 0 || k == kPanels ? 0.5 : 1.0) * value;
  }
  return sum * t / kPanels;
}

double magnitude(double x) {
  return std::abs(x);
}

void expect_chain(const Run& result, double until, int n, double shift,
                  const std::function<double(double)>& element) {
  const std::vector<double> t = row_values(result, "t");
  const std::vector<double> last = row_values(result, "x" + std::to_string(n));
  for (std::size_t r = 0; r < t.size(); ++r)
    ASSERT_NEAR(last[r], chained(std::sin(t[r]), n, shift, element), kError) << t[r];
  EXPECT_NEAR(row_values(result, "z").back(), integral(until, n, shift, element), until * kError);
}

struct Case {
  const char* name;
  const char* block;
  int length;
  double shift;
  double (*element)(double);
};
void PrintTo(const Case& tested, std::ostream* out) {
  *out << tested.name;
}

class ChainRun : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Solve, ChainRun,
    ::testing::Values(
        // All on their switching surfaces at the start, and again at π and 2π.
        Case{"MagnitudesFromZero", "\"absolute-value\"", 12, 0, magnitude},
        Case{"ManyMagnitudesFromZero", "\"absolute-value\"", 1000, 0, magnitude},
        Case{"OwnMagnitudesFromZero", "\"own\"", 100, 0, magnitude},
        // Wherever one of them bends, every second of those behind it touches its switching surface.
        Case{"Folds", "\"absolute-value\"", 1000, 0.1, magnitude},
        Case{"OwnFolds", "\"own\"", 300, 0.1, magnitude},
        Case{"DeadZonesOfNoWidth", "\"dead-zone\", low = 0, high = 0", 30, 0, [](double x) { return x; }},
        Case{"LimitersAtTheirLimit", "\"limiter\", low = 0, high = 0.5", 40, 0,
             [](double x) { return std::clamp(x, 0.0, 0.5); }},
        Case{"Rectifiers", "\"rectifier\"", 50, 0, [](double x) { return std::max(x, 0.0); }},
        // (Of zero width, too: it rises by as much as the one behind it takes away.)
        Case{"ClosedRectifiers", "\"rectifier\"", 50, 1e-3, [](double x) { return std::max(x, 0.0); }}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(ChainRun, GoesOnFromManySwitchingSurfacesAtOnce) {
  constexpr double kUntil = 7;
  diagram::BlockLibrary library = shipped_blocks_and("own", kOwnMagnitude);
  library.add(diagram::parse_block(
      "format = \"oblique-block/1\"\ntitle = \"Rectifier\"\n[inputs]\nin = {}\n[outputs]\nout = {}\n"
      "[equations]\nout = \"max(in, 0)\"\n",
      "rectifier.toml", "rectifier"));
  const Case& tested = GetParam();
  const Compiled made(chain(tested.block, tested.length, tested.shift), "", library);
  expect_chain(run_of(made, {.until = kUntil}), kUntil, tested.length, tested.shift, tested.element);
}

// The work of a run does not grow with the chain but by what a single evaluation costs.
TEST(Chains, TakesTheSameStepsHoweverLongItIs) {
  const auto steps = [](int n) {
    const Compiled made(chain("\"absolute-value\"", n, 0.1));
    return run_of(made, {.until = 7}).statistics.steps;
  };
  EXPECT_EQ(steps(100), steps(400));
}

// Of the time alone every crossing is known beforehand, and of those that come at one instant every second is
// none: its event function touches zero. The chain is straight between the tenths of a second, so that the
// trapezoidal rule between them is exact.
TEST(Chains, OfTheTimeAloneFold) {
  constexpr int kLength = 200, kTenths = 70;
  std::string text = "one = { type = \"constant\", value = 1 }\nx0 = { type = \"ramp\" }\n";
  for (int k = 1; k <= kLength; ++k) {
    text += fmt::format("s{} = {{ type = \"summer\", in = [\"x{}\", \"-0.1*one\"] }}\n", k, k - 1);
    text += fmt::format("x{0} = {{ type = \"absolute-value\", in = \"s{0}\" }}\n", k);
  }
  const Compiled made(text + fmt::format("z = {{ type = \"integrator\", in = \"x{}\" }}\n", kLength));
  const auto result = run_of(made, {.until = 0.1 * kTenths});
  double sum = 0;
  for (int k = 0; k <= kTenths; ++k)
    sum += 0.1 * (k == 0 || k == kTenths ? 0.5 : 1) * chained(0.1 * k, kLength, 0.1, magnitude);
  EXPECT_NEAR(row_values(result, "z").back(), sum, 1e-8);  // straight lines: the tolerance, with no margin
}

// Every one of 40 magnitudes of independent states is exactly at its bend: |x_k| = k t.
TEST(BendsAtOnce, NeedNotFollowFromEachOther) {
  constexpr int kMany = 40;
  std::string text = "one = { type = \"constant\", value = 1 }\n";
  std::string sum;
  for (int k = 1; k <= kMany; ++k) {
    text += fmt::format("x{0} = {{ type = \"integrator\", in = \"{1}*one\" }}\n", k, k % 2 == 0 ? k : -k);
    text += fmt::format("a{0} = {{ type = \"absolute-value\", in = \"x{0}\" }}\n", k);
    sum += fmt::format("{}\"a{}\"", k == 1 ? "" : ", ", k);
  }
  const Compiled made(text + "s = { type = \"summer\", in = [" + sum + "] }\n");
  const auto result = run_of(made, {.until = 2});
  EXPECT_NEAR(row_values(result, "s").back(), 2.0 * kMany * (kMany + 1) / 2, 1e-6);  // 1e-9 of it
}

// |x|·|y| where both are 0: t · t², and back along the same way.
TEST(BendsAtOnce, OfAProductAreRight) {
  const Compiled made(R"(x = { type = "integrator", in = "v" }
v = { type = "constant", value = 1 }
y = { type = "integrator", in = "2*x" }
a = { type = "absolute-value", in = "x" }
b = { type = "absolute-value", in = "y" }
p = { type = "multiplier", in = ["a", "b"] }
z = { type = "integrator", in = "p" }
)");
  const auto result = run_of(made, {.until = 2});
  EXPECT_NEAR(row_values(result, "z").back(), 4, 1e-7);  // ∫ t³ dt
}

// A diode that charges fast turns on as its input, at rest so far, rises from rounding: what it does then
// goes along its switching surface within a ten-thousandth of the moment that is looked ahead. v follows e^(t
// − 50) within 1e-5 · d/dt of it.
TEST(BendsAtOnce, HoldWhereAFastDynamicsLeadsBack) {
  const Compiled made(R"--(e = { type = "time-function", formula = "exp(time - 50)" }
zero = { type = "constant", value = 0 }
drop = { type = "summer", in = ["e", "-v"] }
diode = { type = "maximum", in = ["drop", "zero"] }
v = { type = "integrator", in = "1e5*diode" }
)--");
  const auto result = run_of(made, {.until = 50});
  EXPECT_NEAR(row_values(result, "v").back(), 1 - 1e-5, 1e-7);
}

// A friction (which jumps, and slides) among bends on the same instant: x stays where it is, and so do they.
TEST(BendsAtOnce, RestWhileOneOfThemSlides) {
  constexpr int kMany = 20;
  std::string text =
      "x = { type = \"integrator\", in = [\"-f\", \"0.5*one\"] }\n"
      "one = { type = \"constant\", value = 1 }\nf = { type = \"sign\", in = \"x\" }\n"
      "a0 = { type = \"absolute-value\", in = \"2*x\" }\n";
  for (int k = 1; k <= kMany; ++k)
    text += fmt::format("a{} = {{ type = \"absolute-value\", in = \"2*a{}\" }}\n", k, k - 1);
  const Compiled made(text);
  const auto result = run_of(made, {.until = 2});
  EXPECT_NEAR(row_values(result, "x").back(), 0, 1e-9);
  EXPECT_NEAR(row_values(result, "f").back(), 0.5, 1e-6);
}

}  // namespace
}  // namespace oblique::solve
