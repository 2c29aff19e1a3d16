// SPDX-License-Identifier: MIT
// Equations that have no value beyond the edge of the branch on which a switch is latched, against closed
// forms.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/solve/events/edge_values.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::row_values;
using testing::run_of;
using testing::shipped_blocks_and;

constexpr double kPi = std::numbers::pi;

/// The shipped blocks and 'own', which makes an expression of its input.
diagram::BlockLibrary blocks_with(const std::string& expression) {
  return shipped_blocks_and(
      "own", "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"" + expression + "\"\n");
}

/// y is the integral of what 'own' makes of x = sin t, which two integrators make.
const char* const kIntegral = R"toml(
x = { type = "integrator", in = "w" }
w = { type = "integrator", in = "-x", initial = 1 }
f = { type = "own", in = "x" }
y = { type = "integrator", in = "f" }
)toml";

/// The integral of the power p of the sine over a half turn.
double half_turn(double p) {
  return std::sqrt(kPi) * std::tgamma((p + 1) / 2) / std::tgamma(p / 2 + 1);
}

// Powers of what falls through zero, once each turn, and what is 0 times a logarithm there; 0/0 where it
// begins.
TEST(EdgeValues, AreThoseOfTheLastPlaceInside) {
  struct Case {
    std::string expression;
    double half_turn;
  };
  for (const Case& made : {Case{"max(in, 0)^1.5", half_turn(1.5)},
                           {"max(in, 0)^0.3", half_turn(0.3)},
                           {"(abs(in) + in)^2.5", std::pow(2, 2.5) * half_turn(2.5)},
                           {"if(in > 0, in*log(in), 0)", 2 * (std::log(2) - 1)},
                           {"if(in > 0, in*in/in, 0)", 2},
                           {"acos(clip(1 - in, -1, 1)) - acos(clip(1 + in, -1, 1))", 0}}) {
    const diagram::BlockLibrary blocks = blocks_with(made.expression);
    const Compiled compiled(kIntegral, "", blocks);
    for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                              diagram::IntegrationMethod::rodas}) {
      const solve::Run run = run_of(compiled, {.until = 10 * kPi, .samples = 11, .method = method});
      EXPECT_THAT(run.warnings, IsEmpty()) << made.expression;
      // 1000 tolerances times the size, 5 half turns.
      if (made.half_turn != 0) {
        EXPECT_NEAR(row_values(run, "y").back(), 5 * made.half_turn, 5e-5) << made.expression;
      }
      for (const double value : row_values(run, "f")) EXPECT_TRUE(std::isfinite(value)) << made.expression;
    }
  }
}

/// dx/dt of one state at x beyond the edge or on it, with all switches above, where the solver stood at
/// `from`.
double edge_rate(const Compiled& made, double from, double x) {
  network::Workspace workspace(made.program);
  for (const network::Switch& s : made.program.switches()) workspace.set_discrete_state(s.discrete_state, 1);
  EdgeValues edges(made.program, workspace, 1);
  edges.stand_at(0, {&from, 1});
  double rate = 0;
  made.program.derivatives(0, &x, &rate, workspace);
  EXPECT_TRUE(edges.complete_derivatives(0, &x, {&rate, 1}));
  return rate;
}

// 2 + x ln x is 2 at the edge, whatever it is where the solver stood; x ln x of the last place inside is
// 4e-15.
TEST(EdgeValues, BeyondTheEdgeAreThoseOfTheEdge) {
  const diagram::BlockLibrary blocks = blocks_with("if(in > 0, 2 + in*log(in), 0)");
  const Compiled made(R"toml(
f = { type = "own", in = "x" }
x = { type = "integrator", in = "f" }
)toml",
                      "", blocks);
  for (const double from : {0.5, 3.0}) EXPECT_NEAR(edge_rate(made, from, -0.25), 2, 1e-13);
}

// z′ = sin t − sign(z)/2 slides along z = 0 until sin t = 1/2; z ln z is 0 there, and beyond that edge none.
TEST(EdgeValues, AreShownWhileTheEdgeIsASlide) {
  const diagram::BlockLibrary blocks = blocks_with("if(in > 0, in*log(in), 0)");
  const solve::Run run = run_of(Compiled(R"toml(
w = { type = "sine-source", frequency = "1 rad/s" }
z = { type = "integrator", in = ["w", "-0.5*c"] }
c = { type = "sign", in = "z" }
f = { type = "own", in = "z" }
)toml",
                                         "", blocks),
                                {.until = 0.5, .samples = 51});
  EXPECT_THAT(run.warnings, IsEmpty());
  const std::vector<double> t = row_values(run, "t"), c = row_values(run, "c");
  for (std::size_t row = 1; row < t.size(); ++row)
    ASSERT_NEAR(c[row], 2 * std::sin(t[row]), 1e-6) << "it does not slide";
  for (const double value : row_values(run, "f")) EXPECT_NEAR(value, 0, 1e-7);  // z of 1e-9 makes 2e-8
}

// √x, written as 0/0 on the edge, is taken as far inside where another switch reads the same.
TEST(EdgeValues, AreTakenOnceInsideOfAnEdgeThatSwitchesShare) {
  const diagram::BlockLibrary blocks = blocks_with("if(in > 0, in/sqrt(in), 0)");
  const std::string alone = R"toml(
f = { type = "own", in = "x" }
x = { type = "integrator", in = "f" }
)toml";
  const Compiled shared(alone + "c = { type = \"comparator\", in = \"2*x\" }\n", "", blocks);
  ASSERT_EQ(shared.program.switches().size(), 2U);
  ASSERT_EQ(shared.program.switch_structure().members.size(), 1U);
  EXPECT_EQ(edge_rate(shared, 0, 0), edge_rate(Compiled(alone, "", blocks), 0, 0));
}

// The row of an event shows what was before it.
TEST(EdgeValues, AreShownWhereASwitchTurnsOver) {
  const Compiled made(
      R"toml(s = { type = "time-function", formula = "if(sin(time) > 0, exp(-1/sin(time)), 0)" }
)toml");
  const solve::Run run = run_of(made, {.until = 10, .samples = 1001});
  for (const double value : row_values(run, "s")) {
    EXPECT_GE(value, 0);
    EXPECT_LE(value, std::exp(-1) * (1 + 1e-15));
  }
}

// ln(1 − t) ends at 1, where no switch turns over: neither one that did so a little before nor one that rests
// at its level gives it a value beyond.
TEST(EdgeValues, AreNoneWhereNoSwitchLeavesItsSide) {
  const diagram::BlockLibrary blocks = blocks_with("log(1 - in)^3");
  const Compiled made(R"toml(
one = { type = "constant", value = 1 }
r = { type = "integrator", in = "one" }
f = { type = "own", in = "r" }
y = { type = "integrator", in = "f" }
early = { type = "constant", value = 0.99 }
c = { type = "comparator", in = ["r", "-early"] }
rest = { type = "integrator", in = "0*one" }
d = { type = "comparator", in = "rest" }
z = { type = "integrator", in = ["c", "d"] }
)toml",
                      "", blocks);
  EXPECT_THAT(message_of<SolveError>([&] { run_of(made, {.until = 2}); }),
              HasSubstr("the run stopped at t = 1 s"));
}

// 1/t is without bound on the edge from which it starts, and has no limit there.
TEST(EdgeValues, AreNoneWhereThereIsNoLimit) {
  const Compiled made(R"toml(
f = { type = "time-function", formula = "if(time > 0, 1/time, 0)" }
y = { type = "integrator", in = "f" }
)toml");
  EXPECT_THAT(message_of<SolveError>([&] { run_of(made, {.until = 1}); }), HasSubstr("t = "));
}

}  // namespace
}  // namespace oblique::solve
