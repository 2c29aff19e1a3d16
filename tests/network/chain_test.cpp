// SPDX-License-Identifier: MIT
// Chains of switches, each behind the one before: what they cost by their length, and in which order they are
// decided.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "../support/chain.h"
#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::chain;
using testing::Compiled;
using testing::kOwnMagnitude;
using testing::shipped_blocks_and;

constexpr double kShift = 0.1;

class Chain : public ::testing::TestWithParam<const char*> {
 protected:
  diagram::BlockLibrary library_ = shipped_blocks_and("own", kOwnMagnitude);
};
INSTANTIATE_TEST_SUITE_P(Network, Chain,
                         ::testing::Values("\"absolute-value\"", "\"own\"", "\"sign\"",
                                           "\"limiter\", low = -0.5, high = 0.5",
                                           "\"dead-zone\", low = -0.5, high = 0.5"));

// Twice as long a chain has twice as many instructions: what does not depend on the length is the rest.
TEST_P(Chain, CostsByItsLength) {
  const auto instructions = [&](int n) {
    return Compiled(chain(GetParam(), n, kShift), "", library_).program.n_instructions();
  };
  const std::size_t few = instructions(50), more = instructions(100), many = instructions(200);
  EXPECT_EQ(many - more, 2 * (more - few));
}

// From x = 50 all of the first hundreds stand wrong at the start, where all positions are 0: with the first
// one turned the second asks for it, and so on.
TEST(SwitchOrder, SettlesAChainInOneGo) {
  constexpr int kLength = 300;
  const Compiled made(chain("\"absolute-value\"", kLength, kShift));
  const Program& program = made.program;
  Workspace workspace(program);
  const std::vector<double> x{50, 0, 0}, still(3, 0.0);
  std::vector<double> event_functions(program.switches().size());
  ASSERT_TRUE(program.event_functions(0, x.data(), event_functions.data(), workspace));
  int decided = 0;
  program.decide_in_order(
      0, x.data(), still.data(), workspace, [&](std::uint32_t s, double event_function, double /*rate*/) {
        ++decided;
        workspace.set_discrete_state(program.switches()[s].discrete_state, event_function > 0 ? 1 : 0);
      });
  EXPECT_EQ(decided, kLength);
  ASSERT_TRUE(program.event_functions(0, x.data(), event_functions.data(), workspace));
  for (std::size_t s = 0; s < event_functions.size(); ++s)
    EXPECT_EQ(workspace.discrete_state(program.switches()[s].discrete_state) == 1, event_functions[s] > 0)
        << s;
  std::vector<double> signals(program.n_signals());
  ASSERT_TRUE(program.signals(0, x.data(), signals.data(), workspace));
  // 50 − 300 · 0.1, in the arithmetic of 300 subtractions.
  EXPECT_NEAR(signals[made.signal("x300")], 20, 1e-12);
}

// In a single expression, too: 60 magnitudes in each other would take 2⁶⁰ steps if each were built twice.
TEST(Builder, BuildsWhatStandsInsideOnce) {
  std::string inside = "in";
  for (int k = 0; k < 60; ++k) inside = k % 2 == 0 ? "abs(" + inside + ")" : "deadzone(" + inside + ", 0.01)";
  const diagram::BlockLibrary library = shipped_blocks_and(
      "nest", "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"" + inside + "\"\n");
  const Compiled made("n = { type = \"nest\", in = \"x\" }\nx = { type = \"integrator\", in = \"n\" }\n", "",
                      library);
  EXPECT_EQ(made.program.switches().size(), 90U);  // one of a magnitude, two of a dead zone
}

// Where u rises through 0 the rates of |u|, ||u|| … are 1, once the first position says so.
TEST(SwitchOrder, GivesEachRateByThePositionsBefore) {
  const Compiled made(chain("\"absolute-value\"", 4, 0));
  const Program& program = made.program;
  Workspace workspace(program);
  const std::vector<double> x{0, 1, 0}, dxdt{1, 0, 0};
  std::vector<double> rates(program.switches().size(), 0.0);
  const auto run_down = [&](const std::vector<double>& along) {
    program.decide_in_order(
        0, x.data(), along.data(), workspace, [&](std::uint32_t s, double /*event_function*/, double rate) {
          rates[s] = rate;
          workspace.set_discrete_state(program.switches()[s].discrete_state, rate > 0 ? 1 : 0);
        });
  };
  run_down(dxdt);
  EXPECT_EQ(rates, (std::vector<double>{1, 1, 1, 1}));
  run_down({-1, 0, 0});
  EXPECT_EQ(rates, (std::vector<double>{-1, 1, 1, 1}));
}

TEST(SwitchOrder, LeavesOutWhatDependsOnItselfOrOnLoops) {
  const Compiled made(R"(m = { type = "summer", in = ["-x", "0.5*c"] }
c = { type = "sign", in = "m" }
x = { type = "integrator", in = "c" }
k = { type = "sign", in = "x" }
)");
  const Program& program = made.program;
  for (std::size_t s = 0; s < program.switches().size(); ++s) {
    EXPECT_EQ(program.is_ordered(s), program.switches()[s].block == "k") << s;
  }
}

TEST(SwitchStructure, FollowsAChain) {
  const Compiled made(chain("\"absolute-value\"", 3, kShift));
  const SwitchStructure& structure = made.program.switch_structure();
  EXPECT_EQ(structure.positions_below(2), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_TRUE(structure.depends(2, 0));
  EXPECT_FALSE(structure.depends(0, 2));
  EXPECT_EQ(structure.followers_of({false, true, false}), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(structure.followers_of({true, false, false}), (std::vector<bool>{false, true, true}));
}

// |x| of one's own is equal on both sides at 0 only; a step of one's own nowhere.
TEST(Pieces, MeetWhereTheyAreEqual) {
  const diagram::BlockLibrary library = shipped_blocks_and("own", kOwnMagnitude);
  const auto meet = [&](const char* block, double x) {
    const Compiled made(
        "a = { type = " + std::string(block) + ", in = \"x\" }\nx = { type = \"integrator\", in = \"a\" }\n",
        "", library);
    Workspace workspace(made.program);
    std::vector<double> event_functions(made.program.switches().size());
    return made.program.event_functions(0, &x, event_functions.data(), workspace).value().pieces_meet(0);
  };
  EXPECT_TRUE(meet("\"own\"", 0));
  EXPECT_FALSE(meet("\"own\"", 0.5));
  EXPECT_FALSE(meet("\"sign\"", 0));
}

}  // namespace
}  // namespace oblique::network
