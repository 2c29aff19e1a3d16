// SPDX-License-Identifier: MIT
#include <oblique/network/program/program_compiler.h>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Vector = std::vector<double>;

/// u' = sin x, and the algebraic loops of x > 0, y, from what is needed first to what is needed last:
///
///     q = 0.3/x           a derivative needs it          linear, by an amplifier
///     v = 0.3/√q          so                             linear, by an amplifier; r = √q before it is not
///     s = y/(1 + x/2)     the comparator alone           linear, cut at the summer
///     w = √s              nothing but itself             not linear, by an amplifier
constexpr const char* kLoops = R"(z = { type = "constant", value = 0.3 }
sx = { type = "sine", in = "x" }
u = { type = "integrator", in = ["sx"] }
x = { type = "integrator", in = ["q"], initial = 1 }
y = { type = "integrator", in = ["v", "-2*y"] }
xq = { type = "multiplier", in = ["x", "q"] }
q = { type = "servo-amplifier", in = ["xq", "-z"], gain = inf, bandwidth = inf }
rr = { type = "multiplier", in = ["r", "r"] }
r = { type = "servo-amplifier", in = ["rr", "-q"], gain = inf, bandwidth = inf, initial = 1 }
rv = { type = "multiplier", in = ["r", "v"] }
v = { type = "servo-amplifier", in = ["rv", "-z"], gain = inf, bandwidth = inf }
s = { type = "summer", in = ["y", "0.5*p"] }
p = { type = "multiplier", in = ["-s", "x"] }
tenth = { type = "constant", value = 0.1 }
c = { type = "comparator", in = ["s", "-tenth"] }
ww = { type = "multiplier", in = ["w", "w"] }
w = { type = "servo-amplifier", in = ["ww", "-s"], gain = inf, bandwidth = inf, initial = 1 }
)";

std::vector<std::string> loops_of(const ProgramCode& code, const std::vector<ProgramCode::Step>& steps) {
  std::vector<std::string> names;
  for (const ProgramCode::Step& step : steps) {
    if (!step.loop) continue;
    for (const std::size_t u : code.loops[*step.loop].unknowns) names.push_back(code.unknowns[u].name);
  }
  return names;
}

const LoopCode& loop_of(const ProgramCode& code, const std::string& unknown) {
  for (std::size_t l = 0; l < code.loops.size(); ++l) {
    for (const std::size_t u : code.loops[l].unknowns) {
      if (code.unknowns[u].name == unknown) return code.loop_codes[l];
    }
  }
  throw std::out_of_range(unknown);
}

TEST(ProgramCompiler, SolvesALoopInTheFirstStepsThatNeedItAndNoOthers) {
  const Compiled made(kLoops);
  const ProgramCode code = compile(assemble(made.flat));
  EXPECT_THAT(loops_of(code, code.derivative_steps), ElementsAre("q", "r", "v"));
  EXPECT_THAT(loops_of(code, code.event_function_steps), ElementsAre("s"));
  EXPECT_THAT(loops_of(code, code.signal_steps), ElementsAre("w"));
}

TEST(ProgramCompiler, KnowsWhichLoopsAreLinearAndWhatHoldsThem) {
  const Compiled made(kLoops);
  const ProgramCode code = compile(assemble(made.flat));
  for (const char* const linear : {"q", "v", "s"}) EXPECT_TRUE(loop_of(code, linear).linear) << linear;
  for (const char* const other : {"r", "w"}) EXPECT_FALSE(loop_of(code, other).linear) << other;
  for (const char* const amplifier : {"q", "r", "v", "w"}) {
    EXPECT_THAT(loop_of(code, amplifier).held_by_amplifier, ElementsAre(true)) << amplifier;
    EXPECT_THAT(loop_of(code, amplifier).natural_scale, ElementsAre(0)) << amplifier;
  }
  EXPECT_THAT(loop_of(code, "s").held_by_amplifier, ElementsAre(false));
  EXPECT_THAT(loop_of(code, "s").natural_scale, ElementsAre(1));
}

// One step of a run: each evaluation goes on from the one before. r = √q and w = √s are found to rounding.
TEST(ProgramCompiler, GivesWhatTheEquationsGive) {
  const Compiled made(kLoops);
  const Program& program = made.program;
  Workspace workspace(program);
  for (const auto& [x, y] : {std::pair{1.0, 0.4}, std::pair{0.2, 0.1}, std::pair{3.0, 2.0}}) {
    const Vector states{0, x, y};
    const double q = 0.3 / x, v = 0.3 / std::sqrt(q), s = y / (1 + x / 2);
    Vector slopes(3), surfaces(1), signals(program.n_signals()),
        jacobian(program.jacobian_pattern().entries());
    ASSERT_TRUE(program.derivatives(0, states.data(), slopes.data(), workspace));
    EXPECT_NEAR(slopes[0], std::sin(x), 1e-15);
    EXPECT_NEAR(slopes[1], q, 1e-14);
    EXPECT_NEAR(slopes[2], v - 2 * y, 1e-14);
    ASSERT_TRUE(program.event_functions(0, states.data(), surfaces.data(), workspace));
    EXPECT_NEAR(surfaces[0], s - 0.1, 1e-14);
    ASSERT_TRUE(program.signals(0, states.data(), signals.data(), workspace));
    EXPECT_NEAR(signals[made.signal("s")], s, 1e-14);
    EXPECT_NEAR(signals[made.signal("p")], -s * x, 1e-14);
    EXPECT_NEAR(signals[made.signal("w")], std::sqrt(s), 1e-14);
    EXPECT_NEAR(signals[made.signal("r")], std::sqrt(q), 1e-14);
    ASSERT_TRUE(program.jacobian(0, states.data(), jacobian.data(), workspace));
    // dq/dx = −0.3/x²; v = √(0.3 x), so dv/dx = 0.15/v; nothing depends on u
    const SparsePattern& pattern = program.jacobian_pattern();
    Eigen::Matrix3d found = Eigen::Matrix3d::Zero(), expected;
    expected << 0, std::cos(x), 0, 0, -0.3 / (x * x), 0, 0, 0.15 / v, -2;
    for (std::size_t column = 0; column < 3; ++column) {
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        found(pattern.rows[entry], static_cast<Eigen::Index>(column)) = jacobian[entry];
      }
    }
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-12) << found;  // up to 7.5
  }
}

// Without loops and switches there is one segment of the tape, and nothing else.
TEST(ProgramCompiler, NeedsOneStretchWithoutLoops) {
  const Compiled made("x = { type = \"integrator\", in = [\"-x\"] }\n");
  const ProgramCode code = compile(assemble(made.flat));
  EXPECT_EQ(code.derivative_steps.size(), 1U);
  EXPECT_THAT(loops_of(code, code.derivative_steps), IsEmpty());
  EXPECT_TRUE(code.loop_codes.empty());
  EXPECT_TRUE(code.event_function_slots.empty());
  EXPECT_EQ(code.derivative_slots.size(), 1U);
  EXPECT_EQ(code.first_discrete_state, 2U);  // after the time and x
}

}  // namespace
}  // namespace oblique::network
