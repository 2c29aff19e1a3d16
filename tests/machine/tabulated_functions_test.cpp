// SPDX-License-Identifier: MIT
// Functions become what a machine has for them: function generators, or what stands for these.
#include <oblique/machine/tabulated_functions.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_writer.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/scaled_realisation.h>

#include "machine_runs.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::desk_machine;
using testing::expect_machine_elements;
using testing::greatest_signal;
using ::testing::HasSubstr;
using testing::parsed;
using testing::shipped_blocks;
using testing::trajectory_of;

TEST(TabulatedFunctions, SaysHowFarAFunctionGeneratorIsFromItsFunction) {
  const ScaledRealisation made = realise_scaled(parsed(R"toml(
[run]
until = 1
[blocks]
one   = { type = "constant", value = 1 }
angle = { type = "integrator", in = ["pi/2*one"] }
y     = { type = "cosine", in = "angle" }
)toml"),
                                                shipped_blocks(), desk_machine());
  ASSERT_EQ(made.functions.size(), 1U);
  EXPECT_EQ(made.functions[0].signal, "y");
  EXPECT_EQ(made.functions[0].block, "cosine");
  EXPECT_EQ(made.functions[0].segments, 10);
  EXPECT_NEAR(made.functions[0].high, std::numbers::pi / 2, 1e-6);
  EXPECT_NEAR(made.functions[0].error, 9e-4, 1e-4);  // see LineSegments
  const solve::Trajectory run = trajectory_of(made.diagram);
  const auto y = run.find("y");
  ASSERT_TRUE(y);
  double off = 0;
  for (std::size_t r = 0; r < run.rows(); ++r)
    off = std::max(off, std::abs(run.at(r, *y) - std::cos(std::numbers::pi / 2 * run.at(r, 0) / made.time)));
  EXPECT_NEAR(off, made.functions[0].error, 2e-5);
}

// A forcing by points, (0, 0), (1, 3), (3, −1): its integral at 3 is 1.5 + 2. The lines are those of the
// points, so that what is left is the solver's 1e-8.
TEST(TabulatedFunctions, SetsAFunctionGeneratorByTheLinesOfARecording) {
  const ScaledRealisation made = realise_scaled(parsed(R"toml(
[run]
until = 3
[blocks]
u = { type = "recording", data = [[0, 0], [1, 1.5], [3, -0.5]], scale = 2 }
x = { type = "integrator", in = ["u"] }
[outputs]
x = "x"
)toml"),
                                                shipped_blocks(), desk_machine());
  ASSERT_EQ(made.functions.size(), 1U);
  EXPECT_EQ(made.functions[0].segments, 2);
  const solve::Trajectory run = trajectory_of(made.diagram);
  EXPECT_NEAR(run.at(run.rows() - 1, 1), 3.5, 1e-7);
}

/// What is said of a diagram with one block on the way.
std::string refusal(const std::string& block) {
  return testing::message_of<RealiseError>([&] {
    realise_scaled(parsed("[blocks]\none = { type = \"constant\" }\n"
                          "x = { type = \"integrator\", in = [\"one\"] }\n" +
                          block),
                   shipped_blocks(), desk_machine());
  });
}

// Noise is a function of time, and no ten lines are noise.
TEST(TabulatedFunctions, RefusesAFunctionThatItsLinesMiss) {
  EXPECT_THAT(refusal("n = { type = \"time-function\", formula = \"noise(500*time, 1)\" }\n"),
              ::testing::ContainsRegex(
                  "test.toml:5:1: 10 straight lines miss 'n' \\(time-function\\) by [0-9.]+, which "
                  "itself goes from -[0-9.]+ to [0-9.]+; expected a function that a function "
                  "generator can be set for"));
}

TEST(TabulatedFunctions, RefusesAFunctionThatHasNoLines) {
  EXPECT_THAT(
      refusal("a = { type = \"time-function\", formula = \"atan2(sin(9*time), cos(9*time))\" }\n"),
      HasSubstr("test.toml:5:1: 'a' (time-function) jumps, or is not finite, where its argument runs from 0 "
                "to 1; expected a continuous function, which a function generator can be set for"));
}

// A function of one signal becomes a function generator; of two it has no lines to be set by.
TEST(TabulatedFunctions, TabulatesFunctionsOfOneSignalAlone) {
  diagram::BlockLibrary library = shipped_blocks();
  const auto add = [&](const std::string& name, const std::string& inputs, const std::string& out) {
    library.add(diagram::parse_block("format = \"oblique-block/1\"\ntitle = \"t\"\n[inputs]\n" + inputs +
                                         "[outputs]\nout = {}\n[equations]\nout = \"" + out + "\"\n",
                                     name + ".toml", name));
  };
  add("one", "a = {}\n", "exp(a)");
  add("two", "a = {}\nb = {}\n", "exp(a*b)");
  const std::string x = "[blocks]\nx = { type = \"integrator\", in = \"-p\", initial = 0.5 }\n";
  const std::string one = "p = { type = \"one\", a = \"x\" }\n",
                    two = "p = { type = \"two\", a = \"x\", b = \"x\" }\n";
  EXPECT_THAT(diagram::write_diagram(realise_scaled(parsed(x + one), library, desk_machine()).diagram),
              HasSubstr("function-generator"));
  EXPECT_THAT(
      testing::message_of<RealiseError>([&] { realise_scaled(parsed(x + two), library, desk_machine()); }),
      HasSubstr("'p'"));
}

/// A machine that has comparators and multipliers, and no function generators, as a Model-1.
diagram::MachineProfile without_function_generators() {
  diagram::MachineProfile machine = desk_machine();
  std::erase_if(machine.elements, [](const diagram::ElementCount& element) {
    return element.kind == diagram::ElementKind::function_generator;
  });
  return machine;
}

// What these give is continuous: no row is off.
TEST(TabulatedFunctions, MakesCornersOfComparatorsWhereThereIsNoFunctionGenerator) {
  const diagram::MachineProfile machine = without_function_generators();
  for (
      const std::string block :
      {R"({ type = "limiter", in = "u", low = -0.4, high = 1.3 })",
       R"({ type = "dead-zone", in = "3*u", low = -0.4, high = 1.3 })",
       R"({ type = "function-generator", in = "u", points = [[-1, 1], [0.3, -0.2], [2, 1.5]] })",
       R"({ type = "function-generator", in = "u", points = [[-1, 1], [2, 0.4]] })",
       R"({ type = "function-generator", in = "u", points = { points = [[-1, 1], [1, 0]], beyond = "hold" } })",
       R"({ type = "minimum", x = "u", y = "2*v" })",
       R"({ type = "ramp", slope = 3, start = 0.5, stop = 2.5, initial = -2 })"}) {
    const diagram::Diagram diagram = parsed(fmt::format(R"toml(
[run]
until = 5
[blocks]
u = {{ type = "integrator", in = ["3*w"], initial = 0.1 }}
w = {{ type = "integrator", in = ["-3*u"], initial = 2 }}
one = {{ type = "constant", value = 1 }}
v = {{ type = "integrator", in = ["0.4*one"], initial = -1 }}
y = {}
[outputs]
y = "y"
)toml",
                                                        block));
    const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), machine);
    expect_machine_elements(made.diagram, false);
    EXPECT_THAT(diagram::write_diagram(made.diagram), ::testing::Not(HasSubstr("function-generator")))
        << block;
    EXPECT_TRUE(made.functions.empty()) << block;
    EXPECT_LE(greatest_signal(made.diagram), 1 + 1e-5) << block;
    EXPECT_LT(testing::difference(diagram, made.diagram), 1e-6) << block;
  }
}

// Five corners are too many, and a jump is no corner: the list of elements has one that the machine has none
// of.
TEST(TabulatedFunctions, LeavesFunctionGeneratorsThatComparatorsCannotStandFor) {
  for (const std::string points : {"[[-1, 0], [-0.6, 1], [-0.2, 0], [0.1, 1], [0.3, 0], [0.6, 1], [1, 0]]",
                                   "[[-1, 0], [0.3, 0], [0.3, 1], [1, 1]]"}) {
    const diagram::Diagram diagram = parsed(fmt::format(R"toml(
[run]
until = 5
[blocks]
u = {{ type = "integrator", in = ["3*w"] }}
w = {{ type = "integrator", in = ["-3*u"], initial = 1 }}
y = {{ type = "function-generator", in = "u", points = {} }}
[outputs]
y = "y"
)toml",
                                                        points));
    const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), without_function_generators());
    EXPECT_THAT(diagram::write_diagram(made.diagram), HasSubstr("function-generator")) << points;
    EXPECT_TRUE(made.functions.empty()) << points;
  }
}

}  // namespace
}  // namespace oblique::machine
