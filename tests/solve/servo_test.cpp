// SPDX-License-Identifier: MIT
// The servo amplifier τ ẋ = −x − μ r in loops whose motion has a closed form.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/cvodes_solver.h>
#include <oblique/solve/stability/stability.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

constexpr double kTau = 1 / (2 * std::numbers::pi * 10);  // of 10 Hz [s]

/// r = w (out − u): the loop time constant is τ/(1 + μ w) and the static gain μ w/(1 + μ w).
std::string follower(double weight, double gain, const std::string& input) {
  return fmt::format(
      "out = {{ type = \"servo-amplifier\", in = [\"{0}*out\", \"-{0}*u\"], gain = {1} }}\n{2}\n", weight,
      gain, input);
}

/// The bare equations, from any start.
class PlainSystem final : public OdeSystem {
 public:
  PlainSystem(const network::Program& program, network::Workspace& workspace)
      : program_(program), workspace_(workspace) {}
  std::size_t size() const override { return program_.n_states(); }
  const network::SparsePattern& pattern() const override { return program_.jacobian_pattern(); }
  bool derivatives(double t, const double* x, double* dxdt) override {
    return program_.derivatives(t, x, dxdt, workspace_);
  }
  bool jacobian(double t, const double* x, double* values) override {
    return program_.jacobian(t, x, values, workspace_);
  }

 private:
  const network::Program& program_;
  network::Workspace& workspace_;
};

TEST(ServoAmplifier, AnswersAStepExponentially) {
  constexpr double kWeight = 10, kGain = 5, kU = 0.4, kEnd = 0.002;
  const Compiled made(follower(kWeight, kGain, "u = { type = \"constant\", value = 0.4 }"));
  network::Workspace workspace(made.program);
  PlainSystem system(made.program, workspace);
  const std::vector<double> zero{0};  // not at rest: the step is at t = 0
  CvodesSolver solver(system, 0, zero, kEnd, kEnd, {1e-10, 1e-10, 100'000});
  constexpr double kLoop = 1 + kGain * kWeight;
  while (true) {
    const double t = solver.step();
    const double exact = kU * kGain * kWeight / kLoop * (1 - std::exp(-t * kLoop / kTau));
    EXPECT_NEAR(solver.states()[0], exact, 1e-8) << t;  // 1e-10 a step, some hundred steps
    if (t == kEnd) break;
  }
}

TEST(ServoAmplifier, FollowsARampWithItsLag) {
  constexpr double kWeight = 10, kGain = 20, kSpeed = 0.5;
  const Compiled made(follower(
      kWeight, kGain, "one = { type = \"constant\" }\nu = { type = \"integrator\", in = [\"0.5*one\"] }"));
  const auto result = run_of(made, {.until = 0.01, .tolerance = 1e-10, .samples = 101});
  constexpr double kLoop = 1 + kGain * kWeight, kLag = kTau / kLoop;
  const auto t = row_values(result, "t"), out = row_values(result, "out");
  for (std::size_t r = 0; r < t.size(); ++r) {
    const double ramp = kSpeed * (t[r] - kLag * (1 - std::exp(-t[r] / kLag)));
    EXPECT_NEAR(out[r], kGain * kWeight / kLoop * ramp, 1e-9) << t[r];
  }
}

TEST(ServoAmplifier, LeavesTheStaticErrorOfItsGain) {
  for (const double gain : {1e2, 1e4, 1e6}) {
    const Compiled made(follower(2, gain, "u = { type = \"constant\", value = 0.4 }"));
    std::vector<double> x = made.program.start();
    const auto result = run_of(made, {.samples = 11});
    const double out = row_values(result, "out").back();
    // δ = −out/(μ ∂r/∂out), exactly, since the residual is linear: rounding only.
    EXPECT_NEAR(out - 0.4, -out / (gain * 2), 1e-15) << gain;
  }
}

// c² − (c₀² …): the shipped lesson's loop; ∂r/∂c = 2 c.

TEST(ServoAmplifier, LeavesTheStaticErrorOfANonLinearResidual) {
  for (const double gain : {1e3, 1e4, 1e5}) {
    const Compiled made(fmt::format(R"toml(u  = {{ type = "constant", value = 0.25 }}
cc = {{ type = "multiplier", in = ["c", "c"] }}
c  = {{ type = "servo-amplifier", in = ["cc", "-u"], gain = {}, initial = 1 }}
)toml",
                                    gain));
    const double c = row_values(run_of(made, {.samples = 2}), "c").back();
    const double predicted = -0.5 / (gain * 2 * 0.5);
    EXPECT_NEAR(c - 0.5, predicted, 1 / (gain * gain)) << gain;  // the next term of the series
    EXPECT_NEAR(c * c - 0.25 + c / gain, 0, 1e-14);              // and the equation itself
  }
}

// servo_stability against the pole by hand.

TEST(ServoStability, OfOneLoopIsItsPole) {
  for (const double gain : {1.0, 1e3, 1e6}) {
    for (const double weight : {3.0, -3.0}) {
      const Compiled made(follower(weight, gain, "u = { type = \"constant\", value = 0.4 }"));
      network::Workspace workspace(made.program);
      const std::vector<double> x{0.2};
      const double pole = -(1 + gain * weight) / kTau;
      const double found = servo_stability(made.program, workspace, 0, x);
      EXPECT_NEAR(found, pole, 1e-12 * std::abs(pole)) << gain << ' ' << weight;
      EXPECT_EQ(found > 0, weight < 0 && gain * 3 > 1);
    }
  }
}

TEST(ServoStability, DependsOnWhereTheLoopIs) {
  // r = c² − u: 2 c is the derivative, and its sign is that of c.
  const Compiled made(R"toml(u  = { type = "constant", value = 0.25 }
cc = { type = "multiplier", in = ["c", "c"] }
c  = { type = "servo-amplifier", in = ["cc", "-u"], gain = 100, initial = 1 }
)toml");
  network::Workspace workspace(made.program);
  for (const double c : {-0.5, 0.0, 0.5}) {
    const std::vector<double> x{c};
    EXPECT_NEAR(servo_stability(made.program, workspace, 0, x), -(1 + 200 * c) / kTau, 1e-9) << c;
  }
}

TEST(ServoStability, SeesAPairThatRingsUp) {
  // τ ȧ = −a − μ(−b), τ ḃ = −b − μ a: poles (−1 ± iμ)/τ. With −b instead of b in both: (−1 ± μ)/τ.
  const auto stability = [](const char* first, const char* second) {
    const Compiled made(
        fmt::format("a = {{ type = \"servo-amplifier\", in = [\"{}\"], gain = 50 }}\n"
                    "b = {{ type = \"servo-amplifier\", in = [\"{}\"], gain = 50 }}\n",
                    first, second));
    network::Workspace workspace(made.program);
    const std::vector<double> x{0, 0};
    return servo_stability(made.program, workspace, 0, x);
  };
  EXPECT_NEAR(stability("-b", "a"), -1 / kTau, 1e-9);
  EXPECT_NEAR(stability("-b", "-a"), 49 / kTau, 1e-9);
}

TEST(ServoStability, FreezesIntegratorsAndIsMinusInfinityWithoutServos) {
  const Compiled grows("x = { type = \"integrator\", in = [\"5*x\"] }\n");
  network::Workspace workspace(grows.program);
  const std::vector<double> x{1};
  EXPECT_EQ(servo_stability(grows.program, workspace, 0, x), -std::numeric_limits<double>::infinity());
  // out follows x, x reads out: together they would grow, the loop alone does not.
  const Compiled both(
      "out = { type = \"servo-amplifier\", in = [\"out\", \"-x\"], gain = 10 }\n"
      "x = { type = \"integrator\", in = [\"5*out\"] }\n");
  network::Workspace frozen(both.program);
  const std::vector<double> two{0, 1};
  EXPECT_NEAR(servo_stability(both.program, frozen, 0, two), -11 / kTau, 1e-9);
}

TEST(ServoStability, IsNotANumberWhereAnAlgebraicLoopHasNoSolution) {
  const Compiled made(
      "r = { type = \"square-root\", in = \"x\", bandwidth = inf }\n"
      "out = { type = \"servo-amplifier\", in = [\"out\", \"-r\"] }\n"
      "x = { type = \"integrator\", in = [\"out\"] }\n");
  network::Workspace workspace(made.program);
  const std::vector<double> x{0, -1};
  EXPECT_TRUE(std::isnan(servo_stability(made.program, workspace, 0, x)));
}

/// n servo amplifiers in a ring: 2π·10·(−1 − μ(own·s_i − s_{i−1} − s_{i+1} − u)).
std::string servo_ring(int n, double own) {
  std::string text = "one = { type = \"constant\", value = 1 }\n";
  for (int i = 0; i < n; ++i) {
    text += fmt::format(
        "s{0} = {{ type = \"servo-amplifier\", in = [\"{3}*s{0}\", \"-s{1}\", \"-s{2}\", \"-one\"], "
        "gain = 1e4 }}\n",
        i, (i + n - 1) % n, (i + 1) % n, own);
  }
  return text;
}

double ring_stability(int n, double own) {
  const Compiled made(servo_ring(n, own));
  network::Workspace workspace(made.program);
  return servo_stability(made.program, workspace, 0, made.program.start());
}

// The ring's matrix is circulant: its eigenvalues are −2π·10·(1 + μ(own − 2 cos(2πk/n))), the largest at k =
// 0.
TEST(ServoStability, OfARingIsThatOfItsCirculant) {
  for (const double own : {3.0, 2.001, 1.9, -1.0}) {
    const double largest = -2 * std::numbers::pi * 10 * (1 + 1e4 * (own - 2));
    // the QR algorithm's rounding of the whole spectrum, 2π·10·1e4·4
    EXPECT_NEAR(ring_stability(24, own), largest, 1e-7) << own;
  }
  // beyond the reach of QR the bound, which is sharp here
  EXPECT_NEAR(ring_stability(1500, 3), -2 * std::numbers::pi * 10 * (1 + 1e4), 1e-7);
  EXPECT_TRUE(std::isnan(ring_stability(1500, 1.9)));
}

// By dense eigenvalues, 1500³ operations a matter of minutes.
TEST(ServoStability, OfALargeRingCostsNoCubes) {
  const Compiled made(servo_ring(1500, 3));
  const auto result = run_of(made, {.until = 1e-3, .samples = 2});
  EXPECT_NEAR(row_values(result, "s7").back(), 1 / (3 - 2 + 1e-4), 1e-9);  // s(3 − 2) − 1 = −s/μ
}

// Behind the fold of sin y = u, at t = 0.63, it runs to its limit at 1e9 machine units a second: the clock
// shows no moment nearer to the limit than 1e-7, and yet it stands there, and not beside it.
TEST(ServoAmplifier, StandsAtItsLimitHoweverFastItCame) {
  const Compiled made(R"toml(u = { type = "time-function", formula = "1.05*sin(2*time)" }
s = { type = "sine", in = "y" }
y = { type = "servo-amplifier", in = ["s", "-u"], gain = 1e6, bandwidth = 1000, limit = 5 }
)toml");
  using diagram::IntegrationMethod;
  for (const auto method : {IntegrationMethod::bdf, IntegrationMethod::adams, IntegrationMethod::rodas}) {
    const auto result = run_of(made, {.until = 3, .samples = 31, .method = method});
    const std::vector<double> y = row_values(result, "y");
    for (std::size_t row = 7; row <= 21; ++row) EXPECT_EQ(y[row], 5) << diagram::method_name(method) << row;
    for (std::size_t row = 23; row <= 30; ++row) EXPECT_EQ(y[row], -5) << diagram::method_name(method) << row;
  }
}

}  // namespace
}  // namespace oblique::solve
