// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::kCosineAndSine;
using testing::run_of;

/// Runs round an ellipse with the origin inside; the amplifiers have this gain.
solve::Run round_an_ellipse(const std::string& amplifier) {
  const Compiled made(std::string(kCosineAndSine) +
                      fmt::format(R"(x = {{ type = "summer", in = ["0.8*cosine"] }}
y = {{ type = "summer", in = ["0.5*sine"] }}
v = {{ type = "vector-direction", x = "x", y = "y", {} }})",
                                  amplifier));
  return run_of(made, {.until = 2 * std::numbers::pi, .samples = 91});
}

double length(double t) {
  return std::hypot(0.8 * std::cos(t), 0.5 * std::sin(t));
}

TEST(VectorDirection, GivesLengthAndDirectionAllTheWayRound) {
  const auto result = round_an_ellipse("gain = inf, bandwidth = inf");
  // The tolerance of cos t and sin t.
  expect_form(result, "v.length", 1e-6, length);
  expect_form(result, "v.cos", 1e-6, [](double t) { return 0.8 * std::cos(t) / length(t); });
  expect_form(result, "v.sin", 1e-6, [](double t) { return 0.5 * std::sin(t) / length(t); });
}

TEST(VectorDirection, HasTheStaticErrorsOfItsGain) {
  // With weights of 10: 10 (L² − x² − y²) = −L/μ and 10 (L cos ψ − x) = −cos ψ/μ.
  constexpr double kLoop = 10 * 1e3;
  const auto result = round_an_ellipse("gain = 1e3, bandwidth = inf");
  const auto side = [](double t) {
    return std::sqrt(length(t) * length(t) + 0.25 / (kLoop * kLoop)) - 0.5 / kLoop;
  };
  expect_form(result, "v.length", 1e-6, side);
  expect_form(result, "v.cos", 1e-6, [&](double t) { return 0.8 * std::cos(t) / (side(t) + 1 / kLoop); });
}

}  // namespace
}  // namespace oblique::test
