// SPDX-License-Identifier: MIT
#include <oblique/machine/logic_ports.h>

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/flatten.h>

#include "../support/compiled.h"

namespace oblique::machine {
namespace {

using ::testing::ElementsAre;
using testing::shipped_blocks;

/// Those of the block `b` of a diagram.
std::optional<LogicPorts> ports_of(const std::string& b, const std::string& own = {}) {
  diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  if (!own.empty())
    library.add(
        diagram::parse_block("format = \"oblique-block/1\"\ntitle = \"Own\"\n" + own, "own.toml", "own"));
  const diagram::FlatDiagram flat =
      diagram::flatten(diagram::parse_diagram(
                           testing::diagram_text("one = { type = \"constant\" }\nb = " + b + "\n"), "d.toml"),
                       library);
  return logic_ports(flat.blocks[1]);
}

/// A block of one's own whose output is `formula` of x, c and the level v.
std::optional<LogicPorts> own_ports(const std::string& formula) {
  return ports_of(R"({ type = "own", x = "one", c = "one" })", R"([inputs]
x = {}
c = {}
[outputs]
y = {}
[parameters]
v = { default = 2, unit = "machine unit" }
[requires]
diode = 2
[equations]
y = ")" + formula + "\"\n");
}

TEST(LogicPorts, AreClocksAndCarriesAndNoCounts) {
  const auto counter = ports_of(R"({ type = "counter", clock = "one", reset = "one", step = 2 })");
  ASSERT_TRUE(counter.has_value());
  EXPECT_THAT(counter->inputs, ElementsAre(true, true));
  EXPECT_THAT(counter->outputs, ElementsAre(false, true));  // out, carry
  EXPECT_TRUE(counter->scales);

  const auto bit =
      ports_of(R"({ type = "jk-flip-flop", clock = "one", j = "one", k = "one", reset = "one" })");
  ASSERT_TRUE(bit.has_value());
  EXPECT_THAT(bit->inputs, ElementsAre(true, true, true, true));
  EXPECT_THAT(bit->outputs, ElementsAre(true, true));
  EXPECT_FALSE(bit->scales);

  const auto line = ports_of(R"({ type = "delay-line", in = "one", initial = 3 })");
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(line->inputs, ElementsAre(false));
  EXPECT_THAT(line->outputs, ElementsAre(false));

  const auto setting =
      ports_of(R"({ type = "digital-potentiometer", in = "one", up = "one", down = "one" })");
  ASSERT_TRUE(setting.has_value());
  EXPECT_THAT(setting->inputs, ElementsAre(false, true, true));
  EXPECT_THAT(setting->outputs, ElementsAre(false, true));  // out, setting
}

TEST(LogicPorts, AreThoseOfBlocksThatSayWhatTheyTake) {
  EXPECT_FALSE(ports_of(R"({ type = "servo-multiplier", x = "one", y1 = "one" })").has_value());
  const auto own = own_ports("if(c > 0.5, max(x, v), x)");
  ASSERT_TRUE(own.has_value());
  EXPECT_THAT(own->inputs, ElementsAre(false, true));
  EXPECT_THAT(own->outputs, ElementsAre(false));
  const auto by_level = own_ports("if(c > v, x, 0)");  // a level that follows the signals
  ASSERT_TRUE(by_level.has_value());
  EXPECT_THAT(by_level->inputs, ElementsAre(false, false));
}

// What one factor for all would change: a square, and a level whose cosine is taken.
TEST(LogicPorts, AreNoneWhereAFactorWouldChangeWhatTheBlockDoes) {
  EXPECT_FALSE(own_ports("x*x*if(c > 0.5, 1, 0)").has_value());
  EXPECT_FALSE(own_ports("x*cos(v)").has_value());
}

}  // namespace
}  // namespace oblique::machine
