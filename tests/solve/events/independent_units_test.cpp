// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/independent_units.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

std::uint32_t unit_of(const Compiled& made, std::string_view block) {
  const auto& switches = made.program.switches();
  const auto found =
      std::find_if(switches.begin(), switches.end(), [&](const auto& s) { return s.block == block; });
  if (found == switches.end()) throw std::runtime_error("no switch of " + std::string(block));
  return made.program.switch_structure().unit[static_cast<std::size_t>(found - switches.begin())];
}

/// Whether one relay, a, ever acts on another, b, between which there are these blocks.
struct Case {
  const char* name;
  const char* blocks;
  bool acts;
};

class Acts : public ::testing::TestWithParam<Case> {};

TEST_P(Acts, AlongTheWiring) {
  const Compiled made(std::string(GetParam().blocks) + R"(
a = { type = "sign", in = "x" }
x = { type = "integrator", in = "-a" }
b = { type = "sign", in = "y" }
)");
  IndependentUnits units(made.program);
  const std::uint32_t a = unit_of(made, "a"), b = unit_of(made, "b");
  EXPECT_EQ(units.acts(a, b), GetParam().acts);
  EXPECT_FALSE(units.acts(b, a));
  EXPECT_EQ(units.are(a, b), !GetParam().acts);
  EXPECT_TRUE(units.acts(a, a));  // by x
}

const Case kCases[] = {
    {"NotWithoutAWire", "y = { type = \"integrator\", in = \"-b\", rate = \"0.5\" }\n", false},
    {"NotWhereBothAreReadByAThird",
     "y = { type = \"integrator\", in = \"-b\" }\nz = { type = \"integrator\", in = [\"a\", \"b\"] }\n",
     false},
    {"AtOnce", "y = { type = \"summer\", in = \"2*a\" }\n", true},
    {"ByAState", "y = { type = \"integrator\", in = \"x\" }\n", true},
    {"ByAStateOfAState",
     "z = { type = \"integrator\", in = \"a\" }\ny = { type = \"integrator\", in = \"z\" }\n", true},
    {"ByAnotherSwitch",
     "c = { type = \"comparator\", in = \"x\" }\ny = { type = \"integrator\", in = \"c\" }\n", true},
    {"ByWhatAnEventKeeps",
     "y = { type = \"track-and-store\", in = \"clock\", track = \"a\" }\nclock = { type = \"ramp\", slope = "
     "1 }\n",
     true},
    {"ByAStateThatAnEventSets",
     "y = { type = \"integrator\", in = [], set = \"a\", start = \"one\", initial = 0 }\n"
     "one = { type = \"constant\", value = 1 }\n",
     true},
    {"ByAnAlgebraicLoop",
     "y = { type = \"servo-amplifier\", in = [\"x\", \"-y\"], gain = \"inf\", bandwidth = \"inf\" }\n", true},
};
INSTANTIATE_TEST_SUITE_P(Wirings, Acts, ::testing::ValuesIn(kCases),
                         [](const auto& wiring) { return std::string(wiring.param.name); });

// a acts on b, and d on c: a third of the same kind hangs together with neither.
TEST(IndependentUnits, HangTogetherByOthers) {
  const Compiled made(R"(a = { type = "sign", in = "x" }
x = { type = "integrator", in = "-a" }
b = { type = "sign", in = "y" }
y = { type = "integrator", in = ["-b", "a"] }
c = { type = "sign", in = "z" }
z = { type = "integrator", in = ["-c", "b"] }
d = { type = "sign", in = "w" }
w = { type = "integrator", in = "-d" }
)");
  IndependentUnits units(made.program);
  const std::vector<std::uint32_t> all = {unit_of(made, "d"), unit_of(made, "a"), unit_of(made, "c"),
                                          unit_of(made, "b")};
  const std::vector<std::vector<std::size_t>> parts = {{0}, {1, 2, 3}};
  EXPECT_EQ(units.parts_of(all), parts);
  EXPECT_FALSE(units.acts(unit_of(made, "c"), unit_of(made, "a")));
}

// All pairs of as many as there may be are looked at: of more none is, so that a thousand at rest cost
// nothing.
TEST(IndependentUnits, AreTakenTogetherWhereTheyAreMany) {
  std::string blocks;
  for (std::size_t k = 0; k <= IndependentUnits::kMostUnits; ++k) {
    const std::string number = std::to_string(k);
    blocks += "r" + number + " = { type = \"sign\", in = \"x" + number + "\" }\nx" + number +
              " = { type = \"integrator\", in = \"-r" + number + "\" }\n";
  }
  const Compiled made(blocks);
  IndependentUnits units(made.program);
  std::vector<std::uint32_t> all(IndependentUnits::kMostUnits + 1);
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(units.parts_of(all).size(), 1U);
  all.pop_back();
  EXPECT_EQ(units.parts_of(all).size(), IndependentUnits::kMostUnits);
}

// c acts on both relays, of which each acts on itself through its state; b follows a too.
TEST(IndependentUnits, StandBehindThoseThatActOnThem) {
  using Units = std::vector<std::uint32_t>;
  const Compiled made(R"(b = { type = "sign", in = "y" }
y = { type = "integrator", in = ["-b", "a", "c"] }
a = { type = "sign", in = "x" }
x = { type = "integrator", in = ["-a", "c"] }
c = { type = "sign", in = "s" }
s = { type = "sine-source" }
)");
  IndependentUnits units(made.program);
  const std::uint32_t a = unit_of(made, "a"), b = unit_of(made, "b"), c = unit_of(made, "c");
  EXPECT_EQ(units.mutual_of(Units{b, a, c}), (std::vector<Units>{{c}, {a}, {b}}));
  // Two that act on each other stay together.
  const Compiled ring(R"(a = { type = "sign", in = "x" }
x = { type = "integrator", in = "b" }
b = { type = "sign", in = "y" }
y = { type = "integrator", in = "-a" }
)");
  const Units pair{unit_of(ring, "a"), unit_of(ring, "b")};
  EXPECT_EQ(IndependentUnits(ring.program).mutual_of(pair), std::vector<Units>{pair});
}

// What the event of a store sets acts on the relay that reads it, and on no other.
TEST(IndependentUnits, AreActedOnByEvents) {
  const Compiled made(R"(a = { type = "sign", in = "x" }
x = { type = "integrator", in = ["-a", "kept"] }
b = { type = "sign", in = "y" }
y = { type = "integrator", in = "-b" }
ramp = { type = "ramp", slope = 1 }
clock = { type = "pulse-train", period = 1, width = 0.5 }
kept = { type = "track-and-store", in = "ramp", track = "clock" }
)");
  IndependentUnits units(made.program);
  ASSERT_FALSE(made.program.events().empty());
  bool any = false;
  for (const network::Event& event : made.program.events()) {
    any = any || units.acts(event, unit_of(made, "a"));
    EXPECT_FALSE(units.acts(event, unit_of(made, "b")));
  }
  EXPECT_TRUE(any);
}

}  // namespace
}  // namespace oblique::solve
