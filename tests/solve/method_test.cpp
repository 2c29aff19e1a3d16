// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/method.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;

MethodChoice choice_for(const Compiled& made,
                        diagram::IntegrationMethod asked = diagram::IntegrationMethod::automatic,
                        double until = 1) {
  network::Workspace workspace(made.program);
  return choose_method(asked, made.program, workspace, 0, made.program.start(), until);
}

//      ┌──── −y ◄───┐
//      └─► [x] ─► [y]        x″ = −ω² x
std::string ring(double rate) {
  const std::string k = std::to_string(rate);
  return "x = { type = \"integrator\", in = [\"-y\"], initial = 1, rate = " + k + " }\n" +
         "y = { type = \"integrator\", in = [\"x\"], rate = " + k + " }\n";
}

TEST(ChooseMethod, TakesAdamsForAnOscillator) {
  const MethodChoice choice = choice_for(Compiled(ring(3)));
  EXPECT_EQ(choice.method, diagram::IntegrationMethod::adams);
  EXPECT_THAT(choice.reason, HasSubstr("the fastest mode at the start oscillates, at 3 rad/s"));
}

// The diode conducts from t = 0.1 s on: a decay of 1e8 1/s, which shows later only.
// It holds the top of the sine to the 1e-8 that it takes.
TEST(StiffMethod, IsTakenWhereARunBecomesStiff) {
  const Compiled made(R"(
u = { type = "time-function", formula = "sin(time) - 0.1" }
d = { type = "summer", in = ["u", "-v"] }
i = { type = "diode", in = "d", resistance = 1e-8 }
v = { type = "integrator", in = "i" }
)",
                      "[outputs]\nv = { signal = \"v\" }\n");
  RunOptions options;
  options.until = 8;
  const auto found = oblique::solve::run(made.program, made.flat, options);
  EXPECT_EQ(found.method.method, diagram::IntegrationMethod::bdf);
  EXPECT_THAT(found.method.reason, HasSubstr("1e+08 1/s at t = 0."));
  const std::size_t last = found.trajectory.rows() - 1;
  EXPECT_NEAR(found.trajectory.at(last, 1), 0.9, 1e-7);
  EXPECT_TRUE(found.warnings.empty());
}

TEST(ChooseMethod, TakesBdfForServoLoops) {
  const MethodChoice choice =
      choice_for(Compiled(ring(1) + "q = { type = \"servo-amplifier\", in = [\"q\", \"-x\"] }\n"));
  EXPECT_EQ(choice.method, diagram::IntegrationMethod::bdf);
  EXPECT_EQ(choice.reason, "1 servo loop is faster than what it follows");
}

TEST(ChooseMethod, TakesBdfForADecayThatIsFastBesideTheRest) {
  const MethodChoice choice = choice_for(
      Compiled(ring(1) + "d = { type = \"integrator\", in = [\"-d\"], initial = 1, rate = 1000 }\n"));
  EXPECT_EQ(choice.method, diagram::IntegrationMethod::bdf);
  EXPECT_THAT(choice.reason, HasSubstr("a decay of 1e+03 1/s at the start, beside what moves at 1 1/s"));
}

TEST(ChooseMethod, TakesAdamsWhereNothingIsFast) {
  EXPECT_EQ(choice_for(Compiled("d = { type = \"integrator\", in = [\"-d\"], initial = 1 }\n")).method,
            diagram::IntegrationMethod::adams);
}

// The lag follows a sine of the clock: besides its own rate there is only that of the clock, zero.
TEST(ChooseMethod, TakesBdfForALoneDecayThatIsFastBesideTheRun) {
  const Compiled made(R"toml(one = { type = "constant" }
phi = { type = "integrator", in = ["one"] }
s = { type = "sine", in = "phi" }
lag = { type = "integrator", in = ["1e5*s", "-1e5*lag"] }
)toml");
  const MethodChoice choice = choice_for(made, diagram::IntegrationMethod::automatic, 100);
  EXPECT_EQ(choice.method, diagram::IntegrationMethod::bdf);
  EXPECT_EQ(choice.reason, "a decay of 1e+05 1/s at the start of a run of 100 s");
  EXPECT_EQ(choice_for(made, diagram::IntegrationMethod::automatic, 1e-3).method,
            diagram::IntegrationMethod::adams);
  // with Adams this run takes some 1e7 steps
  EXPECT_LT(testing::run_of(made, {.until = 100}).statistics.steps, 20'000);
}

// Lorenz' equations and integrators that take means of them: the eigenvalues of these are zero, and the decay
// of 23 1/s stands beside a growth of 12 1/s.
TEST(ChooseMethod, TakesIntegratorsForNoSlowDecays) {
  const MethodChoice choice =
      choice_for(Compiled(R"toml(x = { type = "integrator", in = ["10*y", "-10*x"], initial = 1e-3 }
xz = { type = "multiplier", in = ["x", "z"] }
xy = { type = "multiplier", in = ["x", "y"] }
y = { type = "integrator", in = ["28*x", "-xz", "-y"] }
z = { type = "integrator", in = ["xy", "-2.6*z"] }
mean = { type = "integrator", in = ["x"], rate = 1e-3 }
mean_of_mean = { type = "integrator", in = ["mean"], rate = 1e-3 }
)toml"),
                 diagram::IntegrationMethod::automatic, 1e4);
  EXPECT_EQ(choice.method, diagram::IntegrationMethod::adams);
  EXPECT_EQ(choice.reason, "nothing is fast at the start");
}

// Ten integrators in a row beside a fast decay: all of them at zero, where eigenvalues of the whole matrix
// would be the tenth root of rounding.
TEST(ChooseMethod, TakesAChainOfIntegratorsForNoMotion) {
  std::string blocks = "d = { type = \"integrator\", in = [\"-d\"], initial = 1, rate = 50 }\n";
  for (int k = 0; k < 10; ++k) {
    blocks += "q" + std::to_string(k) + " = { type = \"integrator\", in = [\"" +
              (k == 0 ? std::string("d") : "q" + std::to_string(k - 1)) + "\"] }\n";
  }
  EXPECT_EQ(choice_for(Compiled(blocks), diagram::IntegrationMethod::automatic, 10).reason,
            "nothing is fast at the start");
  EXPECT_EQ(choice_for(Compiled(blocks), diagram::IntegrationMethod::automatic, 1000).method,
            diagram::IntegrationMethod::bdf);
}

// A damped oscillation is a decay where it is over after two turns; as fast as that it is left to BDF.
TEST(ChooseMethod, TakesStrongDampingForADecay) {
  const auto beside_ring = [](const std::string& damping) {
    return ring(1) + "v = { type = \"integrator\", in = [\"-p\", \"-" + damping + "*v\"], rate = 1000 }\n" +
           "p = { type = \"integrator\", in = [\"v\"], initial = 1, rate = 1000 }\n";
  };
  EXPECT_EQ(choice_for(Compiled(beside_ring("1.4")), diagram::IntegrationMethod::automatic, 10).reason,
            "a decay of 1e+03 1/s at the start, beside what moves at 1 1/s");
  EXPECT_EQ(choice_for(Compiled(beside_ring("0.1")), diagram::IntegrationMethod::automatic, 10).method,
            diagram::IntegrationMethod::adams);
}

TEST(ChooseMethod, TakesBdfWhereItCannotLook) {
  std::string blocks;
  for (int k = 0; k < 201; ++k) {
    blocks += "r" + std::to_string(k) + " = { type = \"integrator\", in = [\"-r" +
              std::to_string((k + 1) % 201) + "\"], initial = 1 }\n";
  }
  const MethodChoice choice = choice_for(Compiled(blocks));
  EXPECT_EQ(choice.method, diagram::IntegrationMethod::bdf);
  EXPECT_EQ(choice.reason, "201 states that act on each other, too many to look for fast ones");
}

TEST(ChooseMethod, ObeysTheDiagram) {
  const Compiled made(ring(1));
  EXPECT_EQ(choice_for(made, diagram::IntegrationMethod::bdf).method, diagram::IntegrationMethod::bdf);
  EXPECT_EQ(choice_for(made, diagram::IntegrationMethod::adams).reason, "as the diagram asks");
}

// The amplitude is a conserved quantity of x″ = −x. What a method leaves of it after 1000 turns is that
// method's own error: at a tolerance of 10⁻⁸ BDF damps by 5·10⁻⁶, and Adams must keep it to 10⁻⁶.
TEST(Circle, KeepsItsAmplitudeByMethod) {
  const Compiled made(ring(1));
  const auto amplitude = [&](diagram::IntegrationMethod method) {
    RunOptions options;
    options.until = 2000 * std::numbers::pi;
    options.samples = 2;
    options.method = method;
    const oblique::solve::Run result = oblique::solve::run(made.program, made.flat, options);
    return std::hypot(result.trajectory.at(1, 1), result.trajectory.at(1, 2));
  };
  EXPECT_NEAR(amplitude(diagram::IntegrationMethod::adams), 1, 1e-6);
  const double bdf = amplitude(diagram::IntegrationMethod::bdf);
  EXPECT_NEAR(bdf, 1, 1e-4);
  EXPECT_LT(bdf, 1 - 1e-6);  // it is BDF indeed
}

}  // namespace
}  // namespace oblique::solve
