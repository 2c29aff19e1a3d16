// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/equations.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/text/expression_parser.h>

#include "../../support/compiled.h"

namespace oblique::report {
namespace {

using testing::Compiled;
using ::testing::ElementsAre;

std::vector<std::string> equations(const std::string& blocks, const std::string& rest = "") {
  std::vector<std::string> lines;
  const Compiled made(blocks, rest);
  for (const RecoveredEquation& equation : recovered_equations(made.flat))
    lines.push_back(equation.left + " = " + equation.right +
                    (equation.start.empty() ? "" : ", from " + equation.start) +
                    (equation.unknown.empty() ? "" : ", solved for " + equation.unknown));
  return lines;
}

// Lorenz's equations with σ = 10, ρ = 28, β = 2.5 as they are scaled for a machine that inverts: x/20, y/25,
// z/50.
TEST(RecoveredEquations, AreThoseOfTheProblem) {
  EXPECT_THAT(equations(R"toml(x = { type = "integrator", in = ["-12.5*y", "-10*minus_x"], initial = 0.05 }
minus_x = { type = "inverter", in = "x" }
xy = { type = "multiplier", in = ["x", "y"] }
xz = { type = "multiplier", in = ["minus_x", "z"] }
z = { type = "integrator", in = ["-10*xy", "2.5*z"] }
y = { type = "integrator", in = ["22.4*minus_x", "y", "-40*xz"] }
)toml",
                        R"toml([machine]
inverting = true
[outputs]
X = { signal = "x", scale = 20 }
Y = { signal = "y", scale = 25 }
Z = { signal = "z", scale = 50 }
)toml"),
              ElementsAre("der(X) = 10*Y - 10*X, from 1", "der(Z) = X*Y - 2.5*Z, from 0",
                          "der(Y) = 28*X - Y - X*Z, from 0"));
}

// ẋ = −y, ẏ = 4 x, in x/5 and y/10 as −X and −Y: the outputs are read behind an inverter and a potentiometer.
TEST(RecoveredEquations, ArePutInTheOutputsThatAreMultiplesOfStates) {
  EXPECT_THAT(equations(R"toml(x_n = { type = "integrator", in = "2*y_n", initial = -0.2 }
y_n = { type = "integrator", in = "2*x" }
x = { type = "inverter", in = "x_n" }
half = { type = "potentiometer", in = "y_n", setting = 0.5 }
)toml",
                        R"toml([machine]
inverting = true
[outputs]
X = { signal = "x", scale = 5 }
Y = { signal = "half", scale = -20 }
Z = { signal = "x_n", scale = 1 }
)toml"),
              ElementsAre("der(X) = -Y, from 1", "der(Y) = 4*X, from 0", "Z = -0.2*X"));
}

TEST(RecoveredEquations, GiveWhatIsNeededTwiceANameOfItsOwn) {
  EXPECT_THAT(equations(R"toml(x = { type = "integrator", in = ["s"], initial = 1 }
y = { type = "integrator", in = ["-2*s"], initial = 1 }
z = { type = "integrator", in = ["-1*s", "x"], initial = 1 }
s = { type = "summer", in = ["x", "2*y", "-3*z", "x2"] }
x2 = { type = "squarer", in = "x" }
)toml",
                        "[outputs]\nx = \"x\"\n"),
              ElementsAre("der(x) = s, from 1", "der(y) = -2*s, from 1", "der(z) = x - s, from 1",
                          "s = x + 2*y - 3*z + x^2"));
}

TEST(RecoveredEquations, KeepTheConditionsOfLoops) {
  EXPECT_THAT(equations(R"toml(z = { type = "constant", value = 0.3 }
x = { type = "integrator", in = ["z"], initial = 0.5 }
xq = { type = "multiplier", in = ["x", "q"] }
q = { type = "servo-amplifier", in = ["xq", "-z"], gain = inf }
)toml",
                        "[outputs]\nq = \"q\"\n"),
              ElementsAre("der(x) = 0.3, from 0.5", "0 = x*q - 0.3, solved for q"));
}

// What is compared stands there as the circuit has it, not by the names that the block's file gives its
// inputs.
TEST(RecoveredEquations, SayWhatSwitchesByTheSignalsThatItCompares) {
  EXPECT_THAT(
      equations(
          R"toml(x = { type = "integrator", in = ["-2*y"], initial = 1 }
y = { type = "integrator", in = ["x"], initial = 0.5 }
l = { type = "limiter", in = "e", low = -0.1, high = 0.2 }
e = { type = "summer", in = ["3*x", "-1*y"] }
m = { type = "maximum", in = ["y", "x"] }
s = { type = "step", at = 2, from = 1, to = 3 }
)toml",
          "[outputs]\nX = { signal = \"x\", scale = 10 }\ny = \"y\"\nl = \"l\"\nm = \"m\"\ns = \"s\"\n"),
      ElementsAre("der(X) = -20*y, from 10", "der(y) = 0.1*X, from 0.5",
                  "l = if(0.3*X - y > 0.2, 0.2, if(y - 0.3*X > 0.1, -0.1, 0.3*X - y))",
                  "m = if(y - 0.1*X > 0, y, 0.1*X)", "s = if(t >= 2, 3, 1)"));
  // what a comparator switches elsewhere is told by what the comparator compares
  EXPECT_THAT(equations(R"toml(x = { type = "integrator", in = ["f"], initial = 1 }
h = { type = "constant", value = 0.5 }
c = { type = "comparator", in = ["x", "h"] }
d = { type = "comparator", in = ["x"], low = 1, high = -1 }
f = { type = "electronic-switch", on = "x", off = "h", control = "c" }
g = { type = "electronic-switch", on = "x", off = "h", control = "d", threshold = 0 }
)toml",
                        "[outputs]\nx = \"x\"\ng = \"g\"\n"),
              ElementsAre("der(x) = if(x > -0.5, x, 0.5), from 1", "g = if(x <= 0, x, 0.5)"));
  // a comparator that its own output holds: what it compares cannot be written out without end
  EXPECT_THAT(
      equations("x = { type = \"integrator\", in = [\"c\"], initial = 1 }\nc = { type = \"comparator\", "
                "in = [\"x\", \"0.5*c\"] }\n",
                "[outputs]\nx = \"x\"\n"),
      ElementsAre(::testing::HasSubstr("der(x) = if(")));
}

std::vector<std::string> shipped_diagrams() {
  std::vector<std::string> names;
  for (const char* const folder : {"historical", "lessons", "atlas"}) {
    const std::filesystem::path path = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + folder;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (entry.path().extension() == ".toml") names.push_back(entry.path().string());
    }
  }
  return names;
}

/// A name as the language of expressions can have it.
std::string identifier(const std::string& name) {
  std::string text = "n_";
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      text += c;
    } else {
      text += "_" + std::to_string(static_cast<unsigned char>(c)) + "_";
    }
  }
  return text;
}

// The printed equations, read as text and evaluated, against the compiled program at random states: of every
// shipped diagram in which nothing switches.
TEST(RecoveredEquations, SayWhatTheProgramComputes) {
  std::mt19937_64 random(1);  // NOLINT(cert-msc51-cpp): the same states each time
  std::uniform_real_distribution<double> anywhere(0.1, 0.9);
  int held = 0;
  for (const std::string& file : shipped_diagrams()) {
    const diagram::Diagram diagram = diagram::read_diagram(file);
    const diagram::FlatDiagram flat = as_operated(diagram::flatten(diagram, testing::shipped_blocks()));
    const network::Program program(network::assemble(flat));
    if (!program.discrete_states().empty() || !program.unknowns().empty() || program.n_states() == 0)
      continue;
    std::vector<double> x(program.n_states()), dxdt(program.n_states()), signals(program.n_signals());
    for (double& value : x) value = anywhere(random);
    network::Workspace workspace(program);
    const double t = 0.25;
    ASSERT_TRUE(program.signals(t, x.data(), signals.data(), workspace)) << file;
    ASSERT_TRUE(program.derivatives(t, x.data(), dxdt.data(), workspace)) << file;
    std::map<std::string, double> values, rates;
    for (std::size_t s = 0; s < program.n_signals(); ++s) values[program.signal_names()[s]] = signals[s];
    for (std::size_t s = 0; s < program.n_states(); ++s) {
      values[program.states()[s].name] = x[s];
      rates[program.states()[s].name] = dxdt[s];
    }
    // Outputs that have an equation for their rate are multiples of states: of these a step along the rates,
    // by a twentieth of a machine unit at the most, gives it but for rounding.
    double fastest = 1;
    for (const double rate : dxdt) fastest = std::max(fastest, std::abs(rate));
    const double step = 0.05 / fastest;
    std::vector<double> later(x), signals_later(signals.size());
    for (std::size_t s = 0; s < x.size(); ++s) later[s] += step * dxdt[s];
    ASSERT_TRUE(program.signals(t, later.data(), signals_later.data(), workspace)) << file;
    for (const diagram::FlatOutput& output : flat.outputs) {
      const std::size_t signal = program.signal_index(output.signal);
      rates[output.name] = output.scale * (signals_later[signal] - signals[signal]) / step;
    }
    std::map<std::string, double> shown = values;
    for (const diagram::FlatOutput& output : flat.outputs)
      shown[output.name] = output.scale * signals[program.signal_index(output.signal)] + output.offset;
    shown["t"] = t;
    // Names with dots and blanks have others for the parser; the longest first, since they hold each other.
    std::vector<std::string> names;
    for (const auto& [name, value] : shown) names.push_back(name);
    std::sort(names.begin(), names.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
    for (const RecoveredEquation& equation : recovered_equations(flat, 17)) {
      std::string right = equation.right;
      bool plain = true;
      for (const std::string& name : names) {
        if (text::is_identifier(name)) continue;
        for (std::size_t at = right.find(name); at != std::string::npos; at = right.find(name, at)) {
          right.replace(at, name.size(), identifier(name));
          at += identifier(name).size();
        }
      }
      if (right.find("u1") != std::string::npos || right.find("table") != std::string::npos) plain = false;
      if (!plain) continue;
      const double found = text::evaluate(text::parse_expression(right), [&](std::string_view name) {
        for (const auto& [own, value] : shown) {
          if (own == name || identifier(own) == name) return std::optional(value);
        }
        return std::optional<double>();
      });
      const bool is_rate = equation.left.starts_with("der(");
      const std::string left = is_rate ? equation.left.substr(4, equation.left.size() - 5) : equation.left;
      const double expected = is_rate ? rates.at(left) : shown.at(left);
      // Sums in another order: rounding of terms that may be large beside their sum. A rate is a difference
      // over the step, of numbers up to 1 that are rounded to 1e-16.
      const double size = std::max(is_rate ? fastest : 1, std::abs(expected));
      EXPECT_NEAR(found, expected, (is_rate ? 1e-10 : 1e-9) * size)
          << file << ": " << equation.left << " = " << equation.right;
      ++held;
    }
  }
  EXPECT_GT(held, 60);
}

}  // namespace
}  // namespace oblique::report
