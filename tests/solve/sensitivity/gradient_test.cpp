// SPDX-License-Identifier: MIT
// The gradient of one number by the adjoint, against closed forms and the sensitivities along the run.
#include <oblique/solve/sensitivity/gradient.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;

RunOptions until(double end) {
  RunOptions options;
  options.until = end;
  options.samples = 11;
  options.tolerance = 1e-9;
  return options;
}

constexpr double kGradientTolerance = 1e-7;  // a hundred times that of the run

const char* const kDecay =
    "p = { type = \"potentiometer\", in = \"x\", setting = 0.5 }\n"
    "x = { type = \"integrator\", in = \"-3*p\", initial = 0.7 }\n";

// x = x₀ e^(−k w t) and p = k x at t = 2.
TEST(Gradient, OfAValue) {
  const Compiled made(kDecay);
  const std::vector<std::string> names{"p.setting", "x.in[1]", "x.initial"};
  const double x = 0.7 * std::exp(-3.0);
  const Gradient of_x = gradient(made.program, made.flat, until(5), {RunNumber::Kind::value, "x", 2}, names);
  EXPECT_NEAR(of_x.value, x, kGradientTolerance);
  EXPECT_NEAR(of_x.by_parameter[0], -6 * x, kGradientTolerance);
  EXPECT_NEAR(of_x.by_parameter[1], x, kGradientTolerance);
  EXPECT_NEAR(of_x.by_parameter[2], std::exp(-3.0), kGradientTolerance);
  const Gradient of_p = gradient(made.program, made.flat, until(5), {RunNumber::Kind::value, "p", 2}, names);
  EXPECT_NEAR(of_p.by_parameter[0], x - 3 * x, kGradientTolerance);
  const Gradient by_run =
      gradient(made.diagram, testing::shipped_blocks(), {RunNumber::Kind::value, "x", 2}, names);
  EXPECT_NEAR(by_run.by_parameter[0], -6 * x, 10 * kGradientTolerance) << "at the tolerance of [run]";
}

// ∫ x dt = x₀ (1 − e^(−k w T))/(k w), with E = e^(−3) at T = 2.
TEST(Gradient, OfAnIntegral) {
  const Compiled made(kDecay);
  const Gradient found = gradient(made.program, made.flat, until(2), {RunNumber::Kind::integral, "x", 0},
                                  {"p.setting", "x.initial"});
  const double e = std::exp(-3.0), rate = 1.5;
  EXPECT_NEAR(found.value, 0.7 * (1 - e) / rate, kGradientTolerance);
  EXPECT_NEAR(found.by_parameter[0], 3 * 0.7 * (2 * e / rate - (1 - e) / (rate * rate)), kGradientTolerance);
  EXPECT_NEAR(found.by_parameter[1], (1 - e) / rate, kGradientTolerance);
}

// ∫ t x dt from t = 0 to 2 = x₀ (1 − 4 e^(−3))/1.5²: what is integrated depends on the time too.
TEST(Gradient, OfAnIntegralThatTheTimeWeights) {
  const Compiled made(std::string(kDecay) +
                      "w = { type = \"ramp\" }\ny = { type = \"multiplier\", in = [\"w\", \"x\"] }\n");
  const Gradient found =
      gradient(made.program, made.flat, until(2), {RunNumber::Kind::integral, "y", 0}, {"x.initial"});
  const double by_start = (1 - 4 * std::exp(-3.0)) / (1.5 * 1.5);
  EXPECT_NEAR(found.value, 0.7 * by_start, kGradientTolerance);
  EXPECT_NEAR(found.by_parameter[0], by_start, kGradientTolerance);
}

// What an event stores where the run starts is what it held, 0, and y integrates it.
TEST(Gradient, OfWhatAnEventStoresAtTheStart) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("keep", R"toml(
[inputs]
on = { doc = "Stores." }
[parameters]
kept = { default = 0, doc = "What it stores." }
[outputs]
out = { doc = "What it holds." }
[memories]
m = 0
[equations]
out = "m"
[[events]]
when = "on > 0.5"
set = { m = "kept" }
)toml");
  const Compiled made(R"toml(one = { type = "constant" }
k = { type = "keep", on = "one" }
y = { type = "integrator", in = "k" }
)toml",
                      "", library);
  const Gradient found =
      gradient(made.program, made.flat, until(2), {RunNumber::Kind::value, "y", 2}, {"k.kept"});
  EXPECT_NEAR(found.by_parameter[0], 2, kGradientTolerance);
}

// A servo loop that starts at rest: the gradient holds what its rest depends on.
TEST(Gradient, OfARunThatStartsAtRest) {
  const Compiled made(
      "b = { type = \"constant\", value = 0.5 }\n"
      "c = { type = \"servo-amplifier\", in = [\"c\", \"-b\"], gain = 99, bandwidth = 1000 }\n");
  const Gradient found =
      gradient(made.program, made.flat, until(1), {RunNumber::Kind::value, "c", 0.5}, {"c.gain", "b.value"});
  EXPECT_NEAR(found.by_parameter[0], 0.5 / 1e4, 1e-9);
  EXPECT_NEAR(found.by_parameter[1], 0.99, 1e-7);
}

// Two ways to the same derivatives, by all of its numbers: the pendulum of the lessons, with many parameters.
TEST(Gradient, AgreesWithTheSensitivitiesAlongTheRun) {
  for (const char* const file : {"pendulum", "triangle-aas", "bessel", "double-pendulum"}) {
    const diagram::Diagram diagram =
        diagram::read_diagram(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/lessons/" + file + ".toml");
    const diagram::FlatDiagram flat = diagram::flatten(diagram, testing::shipped_blocks());
    const network::Program program(network::assemble(flat));
    std::vector<std::string> names;
    for (const diagram::FlatBlock& block : flat.blocks) {
      for (std::size_t k = 0; k < block.parameters.size(); ++k) {
        const diagram::ParameterDefinition& parameter = block.definition->parameters[k];
        if (std::isfinite(block.parameters[k]) && block.parameters[k] != 0 && !parameter.points &&
            !parameter.formula)
          names.push_back(block.path + "." + parameter.name);
      }
    }
    RunOptions options = options_of(diagram.run);
    options.until = std::min(options.until, 2.0);
    options.tolerance = 1e-9;
    options.samples = 3;
    options.sensitivity = names;
    const Trajectory rows = solve::run(program, flat, options).trajectory;
    const std::size_t n = flat.outputs.size();
    for (std::size_t o = 0; o < std::min<std::size_t>(n, 2); ++o) {
      const Gradient found = gradient(program, flat, options,
                                      {RunNumber::Kind::value, flat.outputs[o].name, options.until}, names);
      double size = 1e-3;
      for (std::size_t k = 0; k < names.size(); ++k)
        size = std::max(size, std::abs(rows.at(2, 1 + n + o * names.size() + k)));
      for (std::size_t k = 0; k < names.size(); ++k) {
        EXPECT_NEAR(found.by_parameter[k], rows.at(2, 1 + n + o * names.size() + k), 1e-6 * size)
            << file << ": d(" << flat.outputs[o].name << ")/d(" << names[k] << ")";
      }
    }
  }
}

TEST(Gradient, RefusesWhatItDoesNotKnow) {
  const Compiled made(
      "one = { type = \"constant\", value = 1 }\np = { type = \"constant\", value = 0.8 }\n"
      "x = { type = \"integrator\", in = \"one\" }\n"
      "k = { type = \"comparator\", in = [\"x\", \"-p\"], low = 1, high = 2 }\n"
      "y = { type = \"integrator\", in = \"k\" }\n");
  const auto refusal = [&](const std::string& output, double time) {
    return testing::message_of<text::Error>([&] {
      gradient(made.program, made.flat, until(3), {RunNumber::Kind::value, output, time}, {"p.value"});
    });
  };
  EXPECT_THAT(refusal("y", 2), HasSubstr("the adjoint of a run in which something turns over is not known"));
  EXPECT_EQ(refusal("y", 0.5), "");
  EXPECT_EQ(
      refusal("z", 0.5),
      "d.toml: there is no output 'z'; expected the name of an output of the diagram\n  remedy: known: one, "
      "p, x, k, y");
}

}  // namespace
}  // namespace oblique::solve
