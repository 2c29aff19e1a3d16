// SPDX-License-Identifier: MIT
// That what it gives is right is held by flat_equations_test, over all shipped diagrams; here, what decides.
#include <oblique/network/program/parameter_prologue.h>

#include <cmath>

#include <gtest/gtest.h>

#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/flat_equations.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;

struct Prologue {
  Compiled compiled;
  std::vector<std::uint32_t> varied;
  Program program;
  ParameterPrologue prologue;

  Prologue(std::string_view blocks, const std::vector<std::string>& names)
      : compiled(blocks, "\n[outputs]\nx = \"x\"\n"),
        varied(numbers_of(compiled.flat, names)),
        program(assemble(compiled.flat, varied)),
        prologue(program, varied) {}

  static std::vector<std::uint32_t> numbers_of(const diagram::FlatDiagram& flat,
                                               const std::vector<std::string>& names) {
    std::vector<std::uint32_t> numbers;
    for (const std::string& name : names)
      numbers.push_back(find_parameter(flat, ParameterNumbers(flat), name).value().number);
    return numbers;
  }

  /// dx/dt at the start of the first state for these values; no number where the program is another one.
  double rate(const std::vector<double>& values) const {
    std::vector<double> scratch(prologue.scratch_size()), constants(prologue.slots().size());
    if (!prologue.run(values, scratch, constants)) return NAN;
    const std::size_t signals[] = {program.signal_index(compiled.flat.outputs[0].signal)};
    const FlatEquations equations = flat_equations(program, signals);
    std::vector<double> slots = equations.initial_slots;
    for (std::size_t k = 0; k < constants.size(); ++k) slots[prologue.slots()[k]] = constants[k];
    slots[1] = 2;
    run_tape(equations.rates, slots.data());
    return slots[equations.rate_slots[0]];
  }
};

TEST(ParameterPrologue, FollowsWhatIsMadeOfParameters) {
  const Prologue made("x = { type = \"integrator\", in = [\"-0.5*x\"], rate = 3 }", {"x.in[1]", "x.rate"});
  EXPECT_DOUBLE_EQ(made.rate({-0.5, 3}), -3);
  EXPECT_DOUBLE_EQ(made.rate({0.25, 8}), 4);
}

// No value of a held parameter is special: the equations for 1 or 0 serve all others.
TEST(ParameterPrologue, ZeroAndOneAreNumbersAsOthers) {
  const Prologue made("x = { type = \"integrator\", in = [\"1*x\", \"0*x\"], rate = 1 }",
                      {"x.in[1]", "x.in[2]", "x.rate"});
  EXPECT_DOUBLE_EQ(made.rate({1, 0, 1}), 2);
  EXPECT_DOUBLE_EQ(made.rate({2, 3, 5}), 50);
  EXPECT_DOUBLE_EQ(made.rate({0, 0, 5}), 0);
}

// An amplifier of infinite bandwidth has no state: another program.
TEST(ParameterPrologue, AnotherCaseOfABlockIsToldOf) {
  const Prologue made(R"(
      x = { type = "integrator", in = ["-0.5*y"], initial = 1 }
      y = { type = "servo-amplifier", in = ["y", "-x"], gain = 1e4, bandwidth = 100 }
      )",
                      {"y.bandwidth"});
  EXPECT_FALSE(std::isnan(made.rate({200})));
  EXPECT_TRUE(std::isnan(made.rate({std::numeric_limits<double>::infinity()})));
}

}  // namespace
}  // namespace oblique::network
