// SPDX-License-Identifier: MIT
#include <oblique/console/pots.h>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>

#include "../support/compiled.h"

namespace oblique::console {
namespace {

using Vector = std::vector<double>;

Pots pots_of(std::string_view blocks, std::string_view rest = "") {
  return {diagram::parse_diagram(testing::diagram_text(blocks, rest), "d.toml"), testing::shipped_blocks()};
}

/// dx/dt of the only state at x = 1.
double slope(Pots& pots) {
  const network::Program& program = *pots.program();
  network::Workspace workspace(program);
  const double x = 1;
  double derivative = 0;
  EXPECT_TRUE(program.derivatives(0, &x, &derivative, workspace));
  return derivative;
}

const char* const kTurnedDecay =
    "p = { type = \"potentiometer\", in = \"x\", setting = 0.5 }\n"
    "x = { type = \"integrator\", in = \"-3*p\", initial = 1 }\n";

TEST(Pots, AreTurnedAtOnceWhereTheEquationsStay) {
  Pots pots = pots_of(kTurnedDecay);
  const auto before = pots.program();
  EXPECT_EQ(pots.program(), before) << "the same until a pot is turned";
  EXPECT_EQ(pots.turn("p.setting", "0.25"), Turned::at_once);
  EXPECT_EQ(slope(pots), -0.75);
  EXPECT_EQ(pots.turn("p.setting", "1/7"), Turned::at_once) << "and again, which takes a shorter way";
  EXPECT_EQ(slope(pots), -3 * (1.0 / 7));
  EXPECT_EQ(pots.turn("x.in[1]", "-0.3"), Turned::at_once);
  EXPECT_EQ(slope(pots), -0.3 * (1.0 / 7));
  EXPECT_NE(pots.program(), before);
  EXPECT_EQ(pots.setting_of("x.in[1]")->value, -0.3) << "of a weight, too";
  EXPECT_FALSE(pots.setting_of("x.in[2]"));
  EXPECT_FALSE(pots.setting_of("x.in[0]"));
}

TEST(Pots, AreCompiledAnewWhereTheEquationsAreOthers) {
  Pots pots = pots_of(kTurnedDecay);
  EXPECT_EQ(pots.turn("p.setting", "0.25"), Turned::at_once);
  EXPECT_EQ(pots.turn("p.setting", "1"), Turned::compiled_anew);
  EXPECT_EQ(slope(pots), -3);
  EXPECT_EQ(pots.turn("p.setting", "0"), Turned::compiled_anew);
  EXPECT_EQ(slope(pots), 0);
  EXPECT_EQ(pots.turn("p.setting", "0.125"), Turned::compiled_anew);
  EXPECT_EQ(pots.turn("p.setting", "0.375"), Turned::at_once);
  EXPECT_EQ(slope(pots), -1.125);
}

TEST(Pots, OfACompositeTurnWhatFollowsFromThem) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("twice", R"toml([inputs]
in = {}
[outputs]
out = { wire = "b" }
[parameters]
k = { default = 0.25 }
[blocks]
a = { type = "potentiometer", in = "in", setting = "k" }
b = { type = "potentiometer", in = "a", setting = "k/2" }
)toml");
  Pots pots(diagram::parse_diagram(testing::diagram_text("c = { type = \"twice\", in = \"x\" }\n"
                                                         "x = { type = \"integrator\", in = \"-c\" }\n"),
                                   "d.toml"),
            library);
  EXPECT_EQ(slope(pots), -0.03125);
  EXPECT_EQ(pots.turn("c.k", "0.5"), Turned::at_once);
  EXPECT_EQ(slope(pots), -0.125);
  EXPECT_EQ(pots.setting_of("c.b.setting")->value, 0.25);
  EXPECT_EQ(pots.turn("c.b.setting", "0.75"), Turned::at_once);
  EXPECT_EQ(slope(pots), -0.375);
}

TEST(Pots, AreAsTheyWereAfterABadTurn) {
  Pots pots = pots_of(kTurnedDecay);
  for (int again = 0; again < 2; ++again) {
    EXPECT_EQ(testing::message_of<diagram::DiagramError>([&] { pots.turn("p.setting", "often"); }),
              "set p.setting=often: 'often' is not a known constant; expected a number, 'pi' or 'inf'");
    EXPECT_THROW(pots.turn("p.setting", "nan"), diagram::DiagramError);
    EXPECT_THROW(pots.turn("p.setting", "3 s"), diagram::DiagramError);
    EXPECT_THROW(pots.turn("q.setting", "0.3"), diagram::DiagramError);
    pots.turn("p.setting", "0.5");
    EXPECT_EQ(slope(pots), -1.5);
  }
}

}  // namespace
}  // namespace oblique::console
