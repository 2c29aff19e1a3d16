// SPDX-License-Identifier: MIT
// The dyads with slides against their closed forms, and their static errors.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::kCosineAndSine;
using testing::kIntegrated;
using testing::run_of;

/// Runs a dyad on P = 0.3 (cos t, sin t).
solve::Run on_a_crank(const std::string& dyad) {
  const Compiled made(std::string(kCosineAndSine) + R"(one = { type = "constant", value = 1 }
)" + dyad);
  return run_of(made, {.until = 2 * std::numbers::pi, .samples = 91});
}

// A slider-crank whose line lies 0.1 above the pivot: C.x = 0.3 cos t ± √(0.8² − (0.1 − 0.3 sin t)²).
TEST(DyadRrp, IsTheSliderCrank) {
  for (const int side : {1, -1}) {
    const auto result = on_a_crank(fmt::format(
        R"(c = {{ type = "dyad-rrp", px = "0.3*cosine", py = "0.3*sine", ax = "0.2*one", ay = "0.1*one", ux = "one", uy = "0*one", r = 0.8, side = {}, reach = 1.3, gain = inf, bandwidth = inf }})",
        side));
    const auto x = [&](double t) {
      const double height = 0.1 - 0.3 * std::sin(t);
      return 0.3 * std::cos(t) + side * std::sqrt(0.64 - height * height);
    };
    expect_form(result, "c.x", kIntegrated, x);
    expect_form(result, "c.y", kIntegrated, [](double) { return 0.1; });
    expect_form(result, "c.way", kIntegrated, [&](double t) { return (x(t) - 0.2) / 1.3; });
  }
}

// w (s² + h² − r²) = −s/μ in units of reach: s = √(r² − h² + 1/(2wμ)²) − 1/(2wμ).
TEST(DyadRrp, HasTheStaticErrorOfItsGain) {
  const auto result = on_a_crank(
      R"(c = { type = "dyad-rrp", px = "0.3*cosine", py = "0.3*sine", ax = "0*one", ay = "0*one", ux = "one", uy = "0*one", r = 0.8, gain = 1e3, bandwidth = inf })");
  expect_form(result, "c.x", kIntegrated, [](double t) {
    const double half = 0.5 / (10 * 1e3), height = 0.3 * std::sin(t);
    return 0.3 * std::cos(t) + std::sqrt(0.64 - height * height + half * half) - half;
  });
}

// The three-bar: a line hinged to the crank's pin runs past D = (0.5, 0) at the distance k.
TEST(DyadRpr, PointsThroughTheOtherPivot) {
  for (const double offset : {0.0, 0.15, -0.1}) {
    for (const int side : {1, -1}) {
      const auto result = on_a_crank(fmt::format(
          R"(c = {{ type = "dyad-rpr", px = "0.3*cosine", py = "0.3*sine", qx = "0.5*one", qy = "0*one", offset = {}, side = {}, reach = 0.8, gain = inf, bandwidth = inf }})",
          offset, side));
      const auto angle = [&](double t) {
        const double dx = 0.5 - 0.3 * std::cos(t), dy = -0.3 * std::sin(t);
        const double way = side * std::sqrt(dx * dx + dy * dy - offset * offset);
        return std::atan2(dy, dx) - std::atan2(offset, way);
      };
      expect_form(result, "c.cos", kIntegrated, [&](double t) { return std::cos(angle(t)); });
      expect_form(result, "c.sin", kIntegrated, [&](double t) { return std::sin(angle(t)); });
    }
  }
}

// C = (x, y) with |C − P| = 0.5 and |C − Q| = w on P = 0, Q = (0.9, 0): x = (0.81 + 0.25 − w²)/1.8.
TEST(DyadRrrVariable, FollowsItsSide) {
  for (const int side : {1, -1}) {
    const auto result = on_a_crank(fmt::format(
        R"(w = {{ type = "summer", in = ["0.7*one", "0.15*sine"] }}
c = {{ type = "dyad-rrr-variable", px = "0*one", py = "0*one", qx = "0.9*one", qy = "0*one", r2 = "w", r1 = 0.5, side = {}, gain = inf, bandwidth = inf }})",
        side));
    const auto x = [](double t) {
      const double w = 0.7 + 0.15 * std::sin(t);
      return (0.81 + 0.25 - w * w) / 1.8;
    };
    expect_form(result, "c.x", kIntegrated, x);
    expect_form(result, "c.y", kIntegrated, [&](double t) { return side * std::sqrt(0.25 - x(t) * x(t)); });
  }
}

// The same triangle with the source's formulas: the angles ψ of Q → P clockwise, γ at P and α of P → C.
TEST(FourBarCircuit, HasTheAnglesOfItsTriangle) {
  for (const int side : {1, -1}) {
    const auto result = on_a_crank(fmt::format(
        R"(w = {{ type = "summer", in = ["0.7*one", "0.15*sine"] }}
c = {{ type = "four-bar-circuit", qx = "0.72*one", qy = "0.54*one", rocker = "w", coupler = 0.5, side = {}, gain = inf, bandwidth = inf }})",
        side));
    const auto gamma = [](double t) {
      const double w = 0.7 + 0.15 * std::sin(t);
      return std::acos((0.81 + 0.25 - w * w) / (2 * 0.9 * 0.5));
    };
    const auto alpha = [&](double t) { return std::atan2(0.6, 0.8) + side * gamma(t); };
    expect_form(result, "c.diagonal", kIntegrated, [](double) { return 0.9; });
    expect_form(result, "c.cos_psi", kIntegrated, [](double) { return -0.8; });
    expect_form(result, "c.sin_psi", kIntegrated, [](double) { return 0.6; });
    expect_form(result, "c.cos_gamma", kIntegrated, [&](double t) { return std::cos(gamma(t)); });
    expect_form(result, "c.sin_gamma", kIntegrated, [&](double t) { return std::sin(gamma(t)); });
    expect_form(result, "c.cos_alpha", kIntegrated, [&](double t) { return std::cos(alpha(t)); });
    expect_form(result, "c.sin_alpha", kIntegrated, [&](double t) { return std::sin(alpha(t)); });
    expect_form(result, "c.x", kIntegrated, [&](double t) { return 0.5 * std::cos(alpha(t)); });
    expect_form(result, "c.y", kIntegrated, [&](double t) { return 0.5 * std::sin(alpha(t)); });
  }
}

TEST(TriangleVariableSide, SolvesTheLawOfCosines) {
  const auto result = on_a_crank(
      R"(l = { type = "summer", in = ["0.8*one", "0.1*cosine"] }
w = { type = "summer", in = ["0.7*one", "0.15*sine"] }
t = { type = "triangle-variable-side", side = "l", opposite = "w", adjacent = 0.5, gain = inf, bandwidth = inf })");
  const auto cosine = [](double t) {
    const double l = 0.8 + 0.1 * std::cos(t), w = 0.7 + 0.15 * std::sin(t);
    return (0.25 + l * l - w * w) / l;
  };
  expect_form(result, "t.cos", kIntegrated, cosine);
  expect_form(result, "t.sin", kIntegrated, [&](double t) { return std::sqrt(1 - cosine(t) * cosine(t)); });
}

// The line y = 0.4 against one of the slope −4/3 through (0.2, turn), which goes up and down.
TEST(DyadPrp, IsWhereTheLinesMeet) {
  const Compiled made(R"(one = { type = "constant", value = 1 }
turn = { type = "sine-source", amplitude = 0.5 }
c = { type = "dyad-prp", ax = "0*one", ay = "0.4*one", ux = "one", uy = "0*one", bx = "0.2*one", by = "turn", vx = "0.6*one", vy = "-0.8*one", side = -1, gain = inf, bandwidth = inf })");
  const auto result = run_of(made, {.until = 1, .samples = 21});
  const auto turn = testing::row_values(result, "turn"), x = testing::row_values(result, "c.x");
  for (std::size_t row = 0; row < x.size(); ++row) {
    // from (0.2, turn) by (0.6, −0.8)·λ to the height 0.4
    EXPECT_NEAR(x[row], 0.2 + 0.6 * (turn[row] - 0.4) / 0.8, testing::kRounding);
  }
}

}  // namespace
}  // namespace oblique::test
