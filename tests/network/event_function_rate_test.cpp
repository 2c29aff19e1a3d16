// SPDX-License-Identifier: MIT
// What the search for events knows beforehand: rates of event functions, the structure of switches.
#include <cmath>

#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;

/// The event function of switch 0 at (t, x).
double event_function_at(const Program& program, double t, const std::vector<double>& x) {
  Workspace workspace(program);
  std::vector<double> event_functions(program.switches().size());
  EXPECT_TRUE(program.event_functions(t, x.data(), event_functions.data(), workspace));
  return event_functions[0];
}

/// Its rate there, where the states move with their derivatives.
double rate_at(const Program& program, double t, const std::vector<double>& x) {
  Workspace workspace(program);
  std::vector<double> event_functions(program.switches().size()), rates(event_functions.size()),
      derivatives(x.size());
  const auto here = program.event_functions(t, x.data(), event_functions.data(), workspace);
  here.value().derivatives(derivatives.data());
  here->event_function_rates(derivatives.data(), rates.data());
  return rates[0];
}

/// The rate by a central difference along the solution, with nothing of the compiled derivative in it.
double differenced_rate(const Program& program, double t, const std::vector<double>& x) {
  Workspace workspace(program);
  std::vector<double> derivatives(x.size());
  EXPECT_TRUE(program.derivatives(t, x.data(), derivatives.data(), workspace));
  constexpr double kStep = 1e-5;
  std::vector<double> ahead = x, behind = x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    ahead[i] += kStep * derivatives[i];
    behind[i] -= kStep * derivatives[i];
  }
  return (event_function_at(program, t + kStep, ahead) - event_function_at(program, t - kStep, behind)) /
         (2 * kStep);
}

void expect_rate(const Compiled& made, double t, const std::vector<double>& x) {
  const double exact = differenced_rate(made.program, t, x);
  EXPECT_NEAR(rate_at(made.program, t, x), exact,
              1e-8 * (1 + std::abs(exact)));  // the step squared, and rounding
}

TEST(EventFunctionRate, FollowsStatesAndTheTime) {
  expect_rate(Compiled(R"(x = { type = "integrator", in = ["-0.3*y", "0.1*x"], initial = 1 }
y = { type = "integrator", in = ["x"] }
xy = { type = "multiplier", in = ["x", "y"] }
w = { type = "sine-source", frequency = 0.7, phase = 0.2 }
c = { type = "comparator", in = ["xy", "-w"] }
)"),
              0.4, {0.8, -0.6});
}

TEST(EventFunctionRate, PassesThroughAlgebraicLoopsThatFollowEachOther) {
  // q = w/x by one loop, and r = √(1 + q²) by the next; the time enters the first.
  expect_rate(Compiled(R"(x = { type = "integrator", in = ["-0.5*r"], initial = 1 }
one = { type = "constant" }
w = { type = "sine-source", frequency = 0.3 }
xq = { type = "multiplier", in = ["x", "q"] }
q = { type = "servo-amplifier", in = ["xq", "-w"], gain = inf, bandwidth = inf }
qq = { type = "squarer", in = "q" }
rr = { type = "squarer", in = "r" }
r = { type = "servo-amplifier", in = ["rr", "-qq", "-one"], initial = 1, gain = inf, bandwidth = inf }
c = { type = "comparator", in = ["r", "-1.2*one"] }
)"),
              0.4, {0.8});
}

TEST(SwitchStructure, PutsOneSwitchingSurfaceIntoOneUnit) {
  const Compiled made(R"(x = { type = "integrator", in = ["-s", "-a"], initial = 1 }
s = { type = "sign", in = "x" }
a = { type = "absolute-value", in = "x" }
y = { type = "sign", in = "n" }
n = { type = "inverter", in = "x" }
)");
  const SwitchStructure& structure = made.program.switch_structure();
  ASSERT_EQ(made.program.switches().size(), 3U);
  EXPECT_EQ(structure.members.size(), 1U);
  int opposite = 0;
  for (const bool other_side : structure.opposite) opposite += other_side ? 1 : 0;
  EXPECT_EQ(opposite, 1);
}

TEST(SwitchStructure, CouplesWhatIsNoSum) {
  const auto coupled = [](const char* blocks) {
    const Compiled made(blocks);
    return made.program.switch_structure().is_coupled(0, 1);
  };
  EXPECT_FALSE(coupled(R"(x = { type = "integrator", in = ["-s", "2*r"], initial = 1 }
y = { type = "integrator", in = ["-r"] }
s = { type = "sign", in = "x" }
r = { type = "sign", in = "y" }
)"));
  EXPECT_TRUE(coupled(R"(x = { type = "integrator", in = ["-p"], initial = 1 }
y = { type = "integrator", in = ["-r"] }
s = { type = "sign", in = "x" }
r = { type = "sign", in = "y" }
p = { type = "multiplier", in = ["s", "r"] }
)"));
}

TEST(SwitchStructure, SeesWhatAPositionDependsOnThroughALoop) {
  const Compiled made(R"(m = { type = "summer", in = ["-x", "0.5*c"] }
c = { type = "sign", in = "m" }
x = { type = "integrator", in = "c" }
k = { type = "sign", in = "x" }
)");
  const SwitchStructure& structure = made.program.switch_structure();
  const auto number = [&](std::string_view block) {
    for (std::size_t s = 0; s < made.program.switches().size(); ++s) {
      if (made.program.switches()[s].block == block) return s;
    }
    return std::size_t{99};
  };
  EXPECT_TRUE(structure.depends(number("c"), number("c")));
  EXPECT_FALSE(structure.depends(number("k"), number("c")));
  EXPECT_FALSE(structure.depends(number("k"), number("k")));
}

}  // namespace
}  // namespace oblique::network
