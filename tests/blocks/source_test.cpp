// SPDX-License-Identifier: MIT
// ramp, step, pulse-train, noise-source, time-function.
#include <cmath>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::expect_form_where;
using testing::kIntegrated;
using testing::kRounding;
using testing::last;
using testing::row_values;
using testing::run_of;

TEST(Ramp, RisesBetweenItsTimes) {
  const Compiled made("r = { type = \"ramp\", slope = -0.4, start = 0.7, stop = 2.2, initial = 0.1 }");
  expect_form(run_of(made, {.until = 3, .samples = 302}), "r", kRounding,
              [](double t) { return 0.1 - 0.4 * (std::clamp(t, 0.7, 2.2) - 0.7); });
}

TEST(Step, JumpsExactlyAtItsTime) {
  const Compiled made(R"(s = { type = "step", at = 0.3, from = -1, to = 2 }
zero = { type = "step", at = 0 }
x = { type = "integrator", in = ["s"] })");
  const auto result = run_of(made, {.until = 2, .samples = 18});
  expect_form(result, "s", 0, [](double t) { return t < 0.3 ? -1 : 2; });
  expect_form(result, "zero", 0, [](double) { return 1; });
  EXPECT_NEAR(last(result, "x"), -0.3 + 2 * 1.7, kRounding);  // straight lines, and the corner is met
}

TEST(TimeFunction, GivesItsFormula) {
  const Compiled made(
      R"toml(u = { type = "time-function", formula = "2 + sin(3*time)^2*exp(-time)", scale = 0.4 }
plain = { type = "time-function" }
x = { type = "integrator", in = ["u"] })toml");
  const auto result = run_of(made, {.until = 3, .samples = 101});
  const auto u = [](double t) { return 0.4 * (2 + std::pow(std::sin(3 * t), 2) * std::exp(-t)); };
  expect_form(result, "u", kRounding, u);
  expect_form(result, "plain", kRounding, [](double t) { return std::sin(t); });
  // ∫ sin²(3t) e⁻ᵗ = (1 − e⁻ᵗ)/2 − (1 + e⁻ᵗ (6 sin 6t − cos 6t))/74
  expect_form(result, "x", kIntegrated, [](double t) {
    const double decay = std::exp(-t);
    return 0.4 * (2 * t + (1 - decay) / 2 - (1 + decay * (6 * std::sin(6 * t) - std::cos(6 * t))) / 74);
  });
}

// |t − 1| has a kink, which is an event.
TEST(TimeFunction, SwitchesAtEvents) {
  const Compiled made(R"toml(u = { type = "time-function", formula = "abs(time - 1)" }
x = { type = "integrator", in = ["u"] })toml");
  EXPECT_EQ(made.program.switches().size(), 1U);
  EXPECT_NEAR(last(run_of(made, {.until = 3, .samples = 18}), "x"), 0.5 + 2, kIntegrated);
}

TEST(TimeFunction, KnowsPiAndInf) {
  const Compiled made("u = { type = \"time-function\", formula = \"pi*min(time, inf)\" }\n");
  expect_form(run_of(made, {.until = 3, .samples = 11}), "u", kRounding,
              [](double t) { return std::numbers::pi * t; });
}

TEST(TimeFunction, RefusesWhatIsNoFormulaOfTime) {
  const auto refusal = [](const std::string& formula) {
    return testing::message_of<diagram::DiagramError>(
        [&] { Compiled("u = { type = \"time-function\", formula = " + formula + " }\n"); });
  };
  EXPECT_EQ(
      refusal("\"2*x + t\""),
      "d.toml:3:44: parameter 'u.formula': there is no 'x' in a formula; expected numbers, pi, time and "
      "functions of them\n"
      "d.toml:3:48: parameter 'u.formula': there is no 't' in a formula; expected numbers, pi, time and "
      "functions of them");
  EXPECT_EQ(refusal("[\"time\"]"),
            "d.toml:3:41: parameter 'u.formula' is an array; expected an expression of time, such as \"2 + "
            "sin(3*time)\"");
  EXPECT_EQ(refusal("\"2 +\"").substr(0, 14), "d.toml:3:45: p");
  const diagram::Diagram diagram =
      diagram::parse_diagram(testing::diagram_text("u = { type = \"time-function\" }\n"), "d.toml");
  EXPECT_EQ(testing::message_of<diagram::DiagramError>([&] {
              diagram::flatten(diagram, testing::shipped_blocks(), {{"u.formula", "time"}});
            }),
            "set u.formula=time: 'formula' is a formula; expected a parameter that is a number\n  remedy: "
            "change the formula in the diagram");
}

TEST(PulseTrain, HasItsTimesAndLevels) {
  const Compiled made(
      R"(p = { type = "pulse-train", period = 0.7, width = 0.2, delay = 0.3, low = -1, high = 4 }
x = { type = "integrator", in = ["p"] })");
  const auto result = run_of(made, {.until = 0.3 + 1000 * 0.7, .samples = 1001});
  expect_form_where(
      result, "p", 0, [](double t) { return t > 0.3 && std::fmod(t - 0.3, 0.7) < 0.2 ? 4 : -1; },
      [](double t) {
        const double phase = std::fmod(t - 0.3 + 0.7, 0.7);
        return std::min({phase, 0.7 - phase, std::abs(phase - 0.2)}) > 1e-6;
      });
  // A thousand periods of 4 · 0.2 − 0.5: only rounding adds up.
  EXPECT_NEAR(last(result, "x"), -0.3 + 1000 * 0.3, 1e-9);
}

TEST(PulseTrain, NeverComesAfterAnInfiniteDelay) {
  const Compiled made("p = { type = \"pulse-train\", delay = inf }");
  expect_form(run_of(made, {.until = 10, .samples = 11}), "p", 0, [](double) { return 0; });
}

constexpr const char* kNoise =
    "n = { type = \"noise-source\", rms = 0.2, mean = 0.05, bandwidth = 10, seed = 7 }";

TEST(NoiseSource, HasItsStatistics) {
  // At rows one knot 0.1863/bandwidth of the spline apart the correlation is that of B-splines of degree 11:
  // the ratio of the Eulerian numbers 9738114 and 15724248.
  constexpr int kRows = 100'000;
  const Compiled made(kNoise);
  const auto result = run_of(made, {.until = kRows * 0.1863 / 10, .samples = kRows + 1});
  const auto n = row_values(result, "n");
  const auto size = static_cast<double>(n.size());
  double mean = 0, square = 0, neighbours = 0;
  for (const double value : n) mean += value / size;
  for (std::size_t r = 1; r < n.size(); ++r) {
    square += (n[r] - mean) * (n[r] - mean) / size;
    neighbours += (n[r] - mean) * (n[r - 1] - mean) / size;
  }
  // Some 1e5/3 independent values: 0.5 % standard deviation of each figure; four of them are allowed.
  EXPECT_NEAR(mean, 0.05, 0.02 * 0.2);
  EXPECT_NEAR(std::sqrt(square), 0.2, 0.02 * 0.2);
  EXPECT_NEAR(neighbours / square, 9738114.0 / 15724248.0, 0.02);
}

TEST(NoiseSource, IsReproducibleAndFollowsItsSeed) {
  const Compiled first(kNoise), second(kNoise);
  const Compiled other("n = { type = \"noise-source\", rms = 0.2, mean = 0.05, bandwidth = 10, seed = 8 }");
  const auto values = [](const Compiled& made) {
    return row_values(run_of(made, {.until = 1, .samples = 101}), "n");
  };
  EXPECT_EQ(values(first), values(second));
  EXPECT_NE(values(first), values(other));
}

}  // namespace
}  // namespace oblique::test
