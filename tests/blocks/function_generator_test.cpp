// SPDX-License-Identifier: MIT
// Functions given by points, in the diagram or in a file.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include "../support/scratch_folder.h"
#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using ::testing::HasSubstr;
using testing::kRounding;
using testing::message_of;
using testing::row_values;
using testing::run_of;

constexpr const char* kCircle = R"(x = { type = "integrator", in = ["y"], initial = 1 }
y = { type = "integrator", in = ["-x"] }
)";

TEST(FunctionGenerator, JoinsItsPointsByStraightLines) {
  const Compiled made(
      std::string(kCircle) +
      "f = { type = \"function-generator\", in = \"x\", points = [[-0.5, 1], [0, 0], [0.5, 0.25]] }\n");
  const auto result = run_of(made, {.until = 20, .samples = 401});
  const auto x = row_values(result, "x"), f = row_values(result, "f");
  for (std::size_t r = 0; r < x.size();
       ++r) {  // the lines go on at both ends; a switch is placed within 1e-13
    EXPECT_NEAR(f[r], x[r] < 0 ? -2 * x[r] : 0.5 * x[r], 1e-12) << x[r];
  }
}

TEST(FunctionGenerator, IsIntegratedExactlyAcrossItsCorners) {
  // Over a turn ∫ |cos t| dt = 4.
  const Compiled made(std::string(kCircle) +
                      R"(f = { type = "function-generator", in = "x", points = [[-1, 1], [0, 0], [1, 1]] }
sum = { type = "integrator", in = ["f"] }
)");
  const auto result = run_of(made, {.until = 4 * std::acos(-1.0), .tolerance = 1e-10, .samples = 2});
  EXPECT_NEAR(row_values(result, "sum").back(), 8, 1e-7);  // tolerance 1e-10 a step, some hundred steps
}

TEST(Recording, FollowsAColumnOfAFile) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "measured.csv")
      << "# a step that takes 10 ms\n\"t\", u ,v\n0,0,9\n1,0,9\n1.01,2,9\n3,2,9\n";
  const std::string text = testing::diagram_text(
      "u = { type = \"recording\", data = { file = \"measured.csv\", x = \"t\", y = \"u\" }, scale = 0.5 }\n"
      "x = { type = \"integrator\", in = [\"u\"] }\n");
  const diagram::Diagram diagram = diagram::parse_diagram(text, (folder / "d.toml").string());
  const diagram::FlatDiagram flat = diagram::flatten(diagram, testing::shipped_blocks());
  solve::RunOptions options;
  options.until = 3;
  options.samples = 2;
  const auto result = solve::run(network::Program(network::assemble(flat)), flat, options);
  EXPECT_NEAR(row_values(result, "x").back(), 0.005 + 1.99,
              1e-9);  // tolerance 1e-8 of few steps of low order
}

// 0.1 + x/2 about 0; above it 2 x from 0.2 on and −x from 0.6 on; below it level from −0.4 on.
TEST(FunctionGenerator, TakesBreakpointsAndSlopesAsOnPaper) {
  const Compiled made(R"(u = { type = "ramp", initial = -2 }
f = { type = "function-generator", in = "u", points = { at_zero = 0.1, slope = 0.5, segments = [[0.6, -1], [-0.4, 0], [0.2, 2]] } }
g = { type = "function-generator", in = "u", points = { at_zero = 0.5, slope = -1, segments = [[0, 3]] } })");
  const auto result = run_of(made, {.until = 4, .samples = 402});
  expect_form(result, "f", kRounding, [](double t) {
    const double x = t - 2;
    return x < -0.4 ? -0.1 : x < 0.2 ? 0.1 + 0.5 * x : x < 0.6 ? 0.2 + 2 * (x - 0.2) : 1 - (x - 0.6);
  });
  expect_form(result, "g", kRounding, [](double t) { return 0.5 + (t < 2 ? -(t - 2) : 3 * (t - 2)); });
}

TEST(FunctionGenerator, TakesSlopesInUnits) {
  const Compiled made(
      R"(r = { type = "recording", data = { at_zero = 0.5, slope = "2 machine unit/min", segments = [["1 min", 0]] } })");
  expect_form(run_of(made, {.until = 100, .samples = 101}), "r", kRounding,
              [](double t) { return 0.5 + std::min(t, 60.0) / 30; });
}

std::string refusal(const std::string& points) {
  return message_of<diagram::DiagramError>(
      [&] { Compiled("f = { type = \"function-generator\", in = \"f\", points = " + points + " }\n"); });
}

TEST(FunctionGenerator, RefusesPointsThatMakeNoFunction) {
  EXPECT_EQ(refusal("[[0, 0]]"),
            "d.toml:3:55: parameter 'f.points' has 1 points; expected at least two points");
  EXPECT_THAT(refusal("[[0, 0], [-1, 1]]"),
              HasSubstr("has x = -1 after x = 0; expected points whose x rises from one to the next"));
  EXPECT_THAT(refusal("[[0, 0], [1]]"), HasSubstr("has something other than a point; expected [x, y]"));
  EXPECT_THAT(refusal("3"), HasSubstr("parameter 'f.points' is a number; expected [[x, y], …], or"));
  EXPECT_THAT(refusal("{ file = \"none.csv\", x = \"a\" }"),
              HasSubstr("parameter 'f.points' has no 'y'; expected the name of the column of the value"));
  EXPECT_THAT(refusal("{ file = \"none.csv\", x = \"a\", y = \"b\" }"), HasSubstr("none.csv"));
  EXPECT_EQ(refusal("{ at_zero = 0, slope = 1 }"),
            "d.toml:3:55: parameter 'f.points' has no segments; expected segments = [[breakpoint, slope "
            "beyond it], "
            "…], at least one");
  EXPECT_THAT(refusal("{ at_zero = 0, slope = 1, segments = [] }"), HasSubstr("has no segments"));
  EXPECT_THAT(refusal("{ at_zero = 0, slope = 1, segments = [0.5] }"),
              HasSubstr("has something other than a segment; expected [breakpoint, slope beyond it]"));
  EXPECT_THAT(refusal("{ at_zero = 0, slope = 1, segments = [[1, 2], [1, 3]] }"),
              HasSubstr("has two segments from 1 on; expected breakpoints that differ"));
  EXPECT_THAT(refusal("{ segments = [[1, 2]] }"), HasSubstr("parameter 'f.points' has no 'at_zero'"));
  EXPECT_THAT(refusal("{ at_zero = 0, slope = 1, segments = [[1, 2]], beyond = \"hold\" }"),
              HasSubstr("'beyond'"));
  EXPECT_THAT(refusal("{ at_zero = 0, slope = 1, segments = [[1, \"inf\"]] }"), HasSubstr("not finite"));
  EXPECT_THAT(
      message_of<diagram::DiagramError>([] { Compiled("s = { type = \"summer\", in = [[0, 1]] }\n"); }),
      HasSubstr("input 's.in' is given an array; expected the name of a signal, or a list of names"));
}

TEST(FunctionGenerator, HasItsSecondValueWhereAJumpIsMetExactly) {
  // As written, and as a recording is read: the jump is where its second point is.
  const Compiled made(R"(u = { type = "constant", value = 0.25 }
f = { type = "function-generator", in = "u", points = [[0, 0], [0.25, 0.5], [0.25, -0.5], [1, 1]] }
)");
  EXPECT_EQ(row_values(run_of(made, {.until = 1}), "f").front(), -0.5);
}

TEST(FunctionGenerator, TakesATableOfTwoPoints) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and(
      "line", "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"table(in, 0, 1, 2, 5)\"\n");
  const Compiled made("u = { type = \"constant\", value = 0.5 }\nf = { type = \"line\", in = \"u\" }\n", "",
                      library);
  EXPECT_EQ(row_values(run_of(made, {.until = 1}), "f").front(), 2);
}

std::string refusal_of_table(const std::string& points) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and(
      "fg", "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"table(in, " + points + ")\"\n");
  return message_of<text::Error>([&] { Compiled("f = { type = \"fg\", in = \"f\" }\n", "", library); });
}

TEST(FunctionGenerator, RefusesATableThatMakesNoFunction) {
  // A jump at either end would have no straight line to go on by.
  for (const char* const points : {"0, 1, 0, 2, 1, 3", "0, 1, 1, 2, 1, 3", "0, 1, 2, 2, 1, 3, 4, 4"}) {
    EXPECT_THAT(
        refusal_of_table(points),
        HasSubstr("the x of a table do not rise from point to point; expected x1 < x2 ≤ x3 < …, where two "
                  "that are equal make a jump"))
        << points;
  }
}

TEST(Points, AreWrittenAsTheyAreRead) {
  const Compiled made("f = { type = \"function-generator\", in = \"f\", points = [[-0.5, 1], [0, 0.25]] }\n");
  EXPECT_EQ(diagram::parse_diagram(diagram::write_diagram(made.diagram), "d.toml"), made.diagram);
  EXPECT_THAT(diagram::write_diagram(made.diagram), HasSubstr("points = [[-0.5, 1], [0, 0.25]]"));
}

}  // namespace
}  // namespace oblique::test
