// SPDX-License-Identifier: MIT
// Which parts of the equations a solver may step over: those of the time, and peaks of states.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using testing::shipped_blocks_and;

TEST(Sources, AreTheLargestPartsThatFollowTheTimeAlone) {
  const auto sources = [](const char* blocks) { return Compiled(blocks).program.sources().size(); };
  // The square of the whole sum is one source; a ramp is none, since nothing hides on a straight line.
  EXPECT_EQ(sources(R"(w = { type = "sine-source" }
r = { type = "ramp" }
s = { type = "summer", in = ["w", "r"] }
q = { type = "squarer", in = "s" }
x = { type = "integrator", in = ["q", "-x"] }
)"),
            3U);  // and the outputs w and s, which are shown
  EXPECT_EQ(sources("r = { type = \"ramp\" }\nx = { type = \"integrator\", in = [\"r\", \"-x\"] }\n"), 0U);
}

// Of two sources of the time one is only shown; the other drives x.
TEST(Sources, ActWhereTheyDriveAState) {
  const Compiled made(R"(shown = { type = "sine-source" }
w = { type = "sine-source", frequency = 2 }
x = { type = "integrator", in = ["w", "-x"] }
)");
  ASSERT_EQ(made.program.sources().size(), 2U);
  EXPECT_EQ(std::ranges::count_if(made.program.sources(), &Source::acts), 1);
}

// The sine of the time stands deep in products of the state, and no block gives it by itself.
TEST(Sources, StandWithinProductsOfStates) {
  const diagram::BlockLibrary library = shipped_blocks_and(
      "own",
      "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"in + in*sin(in + in*sin(time))\"\n");
  const Compiled made("o = { type = \"own\", in = \"x\" }\nx = { type = \"integrator\", in = \"-o\" }\n", "",
                      library);
  ASSERT_EQ(made.program.sources().size(), 1U);
  EXPECT_TRUE(made.program.sources()[0].acts);
  EXPECT_FALSE(made.program.sources()[0].by_states);
}

// c goes along a straight line, so that an exponential of it follows the time alone and is no peak of states.
TEST(Sources, FollowAClockAsTheTime) {
  const Compiled made(R"(one = { type = "constant", value = 1 }
c = { type = "integrator", in = ["one"] }
s = { type = "exponential", in = "c" }
x = { type = "integrator", in = ["s", "-x"] }
)");
  EXPECT_EQ(made.program.clocks(), 1U);
  EXPECT_EQ(made.program.source_states(), std::vector<std::size_t>{0});
  ASSERT_EQ(made.program.sources().size(), 1U);
  EXPECT_FALSE(made.program.sources()[0].by_states);
}

// exp(atan(x)): the whole is the peak, the arc tangent is a part of it, and y has no part in it.
TEST(Sources, AreTheLargestPeaksOfStates) {
  const Compiled made(R"(a = { type = "arc-tangent", in = "x" }
e = { type = "exponential", in = "a" }
y = { type = "integrator", in = ["e", "-y"] }
x = { type = "integrator", in = ["-x"], initial = 1 }
)");
  ASSERT_EQ(made.program.sources().size(), 1U);
  EXPECT_TRUE(made.program.sources()[0].by_states);
  EXPECT_TRUE(made.program.sources()[0].acts);
  EXPECT_EQ(made.program.source_states(), std::vector<std::size_t>{1});
  EXPECT_EQ(made.program.clocks(), 0U);
}

// x^16 by four squarers is none, x^32 by five is: the whole of it, and not its parts.
TEST(Sources, AreProductsOfManyFactors) {
  std::string blocks = "x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n";
  std::string last = "x";
  for (int k = 1; k <= 5; ++k) {
    const std::string next = "p" + std::to_string(k);
    blocks += next + " = { type = \"squarer\", in = \"" + last + "\" }\n";
    last = next;
    const Compiled made(blocks + "y = { type = \"integrator\", in = \"" + last + "\" }\n");
    ASSERT_EQ(made.program.sources().size(), k < 5 ? 0U : 1U);
    if (k == 5) {
      EXPECT_TRUE(made.program.sources()[0].by_states);
      EXPECT_TRUE(made.program.sources()[0].acts);
    }
  }
}

// One that acts on a loop that is not linear, by itself or through a linear loop, is known as such; no other
// is.
TEST(Sources, AreToldFromThoseThatActOnBranches) {
  const auto on_branch = [](const std::string& loop) {
    const Compiled made("u = { type = \"sine-source\", frequency = 3 }\n" + loop);
    return std::ranges::count_if(made.program.sources(), &Source::on_branch);
  };
  EXPECT_EQ(on_branch("x = { type = \"integrator\", in = [\"u\"] }\n"), 0);
  const std::string linear =
      "l = { type = \"summer\", in = [\"u\", \"0.5*m\"] }\nm = { type = \"summer\", in = [\"-l\"] }\n";
  EXPECT_EQ(on_branch(linear), 0);
  const auto bent = [](const std::string& in) {
    return "y = { type = \"summer\", in = [\"" + in +
           "\", \"-0.5*q\"] }\nq = { type = \"squarer\", in = \"y\" }\n";
  };
  EXPECT_EQ(on_branch(bent("u")), 1);
  EXPECT_EQ(on_branch(linear + bent("m")), 1);
}

}  // namespace
}  // namespace oblique::network
