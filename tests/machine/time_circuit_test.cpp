// SPDX-License-Identifier: MIT
// Formulas of the time become the circuits that a machine room made of them.
#include <oblique/machine/time_circuit.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_writer.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/scaled_realisation.h>
#include <oblique/text/expression_parser.h>

#include "machine_runs.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::desk_machine;
using testing::expect_machine_elements;
using testing::greatest_signal;
using testing::parsed;
using testing::shipped_blocks;

std::optional<TimeCircuit> circuit_of(const std::string& formula, double until = 10) {
  return time_circuit(text::parse_expression(formula), until);
}

/// "clock", "sine" and the others, sorted.
std::string kinds_of(const std::string& formula) {
  const auto circuit = circuit_of(formula);
  if (!circuit) return "none";
  std::vector<std::string> kinds;
  for (const TimeSignal& signal : circuit->signals) {
    constexpr const char* kNames[] = {"clock", "sine", "exponential", "product", "comparison", "function"};
    kinds.emplace_back(kNames[static_cast<int>(signal.kind)]);
  }
  std::sort(kinds.begin(), kinds.end());
  return fmt::format("{}", fmt::join(kinds, " "));
}

/// The formula as the circuit draws it.
double drawn_at(const TimeCircuit& circuit, double t) {
  std::vector<double> s;
  const auto value = [&](const TimeSum& sum) {
    double total = sum.constant;
    for (const TimeSum::Term& term : sum.terms) total += term.weight * s[term.signal];
    return total;
  };
  for (const TimeSignal& signal : circuit.signals) {
    const double a = value(signal.a), b = value(signal.b);
    switch (signal.kind) {
      case TimeSignal::Kind::clock:
        s.push_back(t);
        break;
      case TimeSignal::Kind::sine:
        EXPECT_GT(signal.rate, 0);
        s.push_back(std::exp(signal.growth * t) * std::sin(signal.rate * t + signal.phase));
        break;
      case TimeSignal::Kind::exponential:
        s.push_back(std::exp(signal.growth * t));
        break;
      case TimeSignal::Kind::product:
        s.push_back(a * b);
        break;
      case TimeSignal::Kind::comparison:
        s.push_back(a > 0 ? 1 : 0);
        break;
      case TimeSignal::Kind::function:
        // the range is looked for at many moments: an extreme is met to 1e-4
        EXPECT_GE(a, signal.range.low - 1e-4 * (signal.range.high - signal.range.low));
        EXPECT_LE(a, signal.range.high + 1e-4 * (signal.range.high - signal.range.low));
        s.push_back(text::evaluate(signal.function, [a](std::string_view) { return a; }));
        break;
    }
  }
  return value(circuit.out);
}

const std::vector<std::pair<std::string, std::string>> formulas{
    {"sin(time)", "sine"},
    {"3 - 2*cos(3*time + 1)", "sine"},
    {"sin(1 - 2*time)/4", "sine"},
    {"cos(0.3*time) + 2*sin(0.1*3*time) - sin(0.3*time + 1)", "sine sine"},  // and its quarter
    {"sin(time + 0.005) - sin(time)", "sine sine"},
    {"-exp(-0.2*time)", "exponential"},
    {"exp(1 - time/3)*cos(4*time)", "sine"},
    {"exp(-time/3)*(2 + cos(4*time) + 3*exp(time/3))", "exponential sine"},
    {"2*exp(-0.5*time) - 3*exp(-time) + 4*exp(1 - time)", "exponential exponential"},
    {"time^2 + 3*time", "clock product"},
    {"(time - 2)^3 + time", "clock product product"},
    {"sin(time)^4", "product product sine"},
    {"time*sin(time) + sin(time)*time", "clock product sine"},
    {"step(time - 2)", "clock comparison"},
    {"sign(sin(3*time + 0.1))", "comparison sine"},
    {"if(time >= 2 and time < 3.5, 5, 1)", "clock comparison comparison"},
    {"if(time >= 2 and time < 2.00001, cos(time), 0)", "clock comparison comparison product sine"},
    {"if(time < 2 or time > 3.5, sin(time), 0.5)", "clock comparison comparison product sine"},
    {"if(time > 2 and time > 3.5, 1, 0)", "clock comparison"},  // nothing needs the other
    {"if(time > 3 or sin(time) > 0.2, 1, 0)", "clock comparison comparison comparison sine"},
    {"step(time)*sin(time) + step(time - 20)*exp(time) + if(time < 100, 2, 3)", "sine"},
    {"not (time <= 2.5)", "clock comparison"},
    {"if(cos(time) > 0.3, 2, time)", "clock comparison product sine"},
    {"abs(sin(time))", "function sine"},
    {"sqrt(abs(2*sin(time) + 0.5))", "function sine"},
    {"1/(2 + cos(time))", "function sine"},
    {"(1 + sin(time))/(2 + cos(2*time))", "function product sine sine"},
    {"sin(time)/(1 + time)", "clock function product sine"},
    {"sin(5*time)/(1 + exp(3 - time))", "clock function product sine"},
    {"(2 + sin(time))^1.5", "function sine"},
    {"clip(2*sin(time), -1, 1)", "function sine"},
    {"max(sin(time), cos(2*time))", "function sine sine"},
    {"min(0.4, sin(time), time/5)", "clock function function sine"},
    {"log(time + 1) + sin(time)", "clock function sine"},
    {"tan(0.1*time)*step(time - 3)", "clock comparison function product"},
    {"time - time + 0*exp(time) + sin(0*time + 1)*cos(time)", "sine"},
};

// What is drawn is the formula, but for rounding: values are of the order of 1 to 1e2.
TEST(TimeCircuit, DrawsTheFormula) {
  for (const auto& [formula, kinds] : formulas) {
    SCOPED_TRACE(formula);
    EXPECT_EQ(kinds_of(formula), kinds);
    const auto circuit = circuit_of(formula);
    ASSERT_TRUE(circuit);
    const text::Expression expression = text::parse_expression(formula);
    for (int k = 0; k <= 1000; ++k) {
      const double t = 0.00317 + 0.00998 * k;  // on no jump
      EXPECT_NEAR(drawn_at(*circuit, t), text::evaluate(expression, [t](std::string_view) { return t; }),
                  1e-12)
          << "at " << t;
    }
  }
}

diagram::Diagram integral_of(const std::string& formula, double until) {
  return parsed(fmt::format(R"toml(
[run]
until = {}
[blocks]
u = {{ type = "time-function", formula = "{}", scale = 2 }}
x = {{ type = "integrator", in = ["u", "-0.3*x"] }}
[outputs]
x = "x"
u = "u"
)toml",
                            until, formula));
}

// One function generator draws what is a smooth function of the time, what grows and decays too.
TEST(TimeCircuit, LeavesWhatIsNone) {
  for (const std::string formula : {"1/(time + 1)",
                                    "exp(-((time - 5)/2)^2)",
                                    "abs(time - 3)",
                                    "2^time",
                                    "sqrt(time)*log(time + 1)",
                                    "max(time, 2)",
                                    "atan2(sin(time), cos(time))",
                                    "sin(time)^cos(time)",
                                    "time == 3",
                                    "if(time, 1, 2)",
                                    "1/(1 + exp(-3*(time - 3)))",
                                    "sqrt(1 + exp(2*time))",
                                    "1/(1 + exp((time - 500)/0.002))",
                                    "max(exp(time), 3)",
                                    "hypot(exp(time), time)",
                                    "sin(exp(time))",
                                    "exp(exp(-time))",
                                    "sin(time)/(time - 5)",
                                    "log(sin(time))",
                                    "exp(200*time)",
                                    "sin(sin(1e6*time))",
                                    "3",
                                    "0*time"})
    EXPECT_EQ(kinds_of(formula), "none") << formula;
}

// Signals that are larger than what becomes of them leave less of a machine's unit to it.
TEST(TimeCircuit, TellsHowMuchLargerItsSignalsAre) {
  const auto excess = [](const std::string& formula) { return circuit_of(formula).value().excess; };
  EXPECT_NEAR(excess("sin(time)"), 1, 1e-12);
  EXPECT_NEAR(excess("2*cos(time) + 3"), 1, 1e-12);
  EXPECT_NEAR(excess("100 + sin(time) - 99"), 1, 1e-12);  // constants become one
  EXPECT_NEAR(excess("time*exp(-time)"), 10 * std::exp(1), 0.01);
  EXPECT_NEAR(excess("exp(-time)*step(time - 5)"), std::exp(5), 0.5);
  EXPECT_NEAR(excess("exp(0.3*time)"), std::exp(3), 1e-9);  // which 10 s make of 1
  EXPECT_NEAR(excess("exp(time) - exp(1.01*time) + sin(time)"), std::exp(10.1), 1);
}

// A gate that opens late lets an exponential through that has decayed, and one that has grown must fit too.
TEST(TimeCircuit, CarriesWhatAGateLetsThroughAsFarAsItCan) {
  const diagram::Diagram late = integral_of("exp(-time)*step(time - 5)", 10);
  EXPECT_LT(testing::difference(late, realise_scaled(late, shipped_blocks(), desk_machine()).diagram), 1e-6);
  EXPECT_THAT(
      testing::message_of<RealiseError>([] {
        realise_scaled(integral_of("if(time < 1, exp(3*time), 0)", 10), shipped_blocks(), desk_machine());
      }),
      ::testing::HasSubstr("test.toml:6:1: 'u' (time-function) would be made of signals up to 1.1e+13 times "
                           "as large as itself; expected a formula whose parts a machine can carry beside "
                           "it\n  remedy: leave out what hardly counts, or let it run for a shorter time"));
}

// Of what grows or decays without turning, elements and straight lines both make errors: the smaller ones.
TEST(TimeCircuit, LeavesADecayToTheLinesWhereTheseErrLess) {
  const auto functions = [](const std::string& formula, double until) {
    return realise_scaled(integral_of(formula, until), shipped_blocks(), desk_machine()).functions.size();
  };
  EXPECT_EQ(functions("exp(-time)", 8), 0U);
  EXPECT_EQ(functions("2*exp(-0.5*time) - 3*exp(-time)", 8), 0U);
  EXPECT_EQ(functions("exp(0.2*time)", 8), 0U);
  EXPECT_EQ(functions("exp(2*time)", 6), 1U);
  EXPECT_EQ(functions("time*exp(-time)", 8), 1U);
  diagram::MachineProfile without = desk_machine();
  std::erase_if(without.elements, [](const diagram::ElementCount& element) {
    return element.kind == diagram::ElementKind::function_generator;
  });
  EXPECT_TRUE(realise_scaled(integral_of("time*exp(-time)", 8), shipped_blocks(), without).functions.empty());
}

// On a machine the sources run as the formulas say; without a function generator in them to the solver's
// 1e-8, which is as much as 1e-7 of what has jumped by then.
TEST(TimeCircuit, RunsOnAMachine) {
  for (const auto& [formula, kinds] : formulas) {
    SCOPED_TRACE(formula);
    const diagram::Diagram diagram = integral_of(formula, 10);
    const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), desk_machine());
    expect_machine_elements(made.diagram, true);
    EXPECT_LE(greatest_signal(made.diagram), 1 + 1e-3);
    EXPECT_EQ(made.functions.empty(), kinds.find("function") == std::string::npos);
    const bool by_lines = std::any_of(made.functions.begin(), made.functions.end(),
                                      [](const auto& function) { return function.error > 1e-9; });
    EXPECT_LT(testing::difference(diagram, made.diagram), by_lines ? 0.03 : 1e-6);
  }
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++found;
  return found;
}

std::string written(const diagram::Diagram& diagram) {
  return diagram::write_diagram(realise_scaled(diagram, shipped_blocks(), desk_machine()).diagram);
}

// One ring for all phases of a frequency; its amplitude is that of the formula, so that nothing stands behind
// it.
TEST(TimeCircuit, MakesOneRingForAFrequency) {
  const diagram::Diagram diagram = parsed(R"toml(
[run]
until = 5
[blocks]
u = { type = "time-function", formula = "7.5*cos(3*time)" }
v = { type = "time-function", formula = "sin(3*time + 0.4)" }
x = { type = "integrator", in = ["u", "v"] }
[outputs]
x = "x"
u = "u"
v = "v"
)toml");
  const std::string text = written(diagram);
  EXPECT_EQ(count(text, "type = \"integrator\""), 3);
  EXPECT_EQ(count(text, "type = \"summer\""), 1);  // v
  EXPECT_LT(testing::difference(diagram, realise_scaled(diagram, shipped_blocks(), desk_machine()).diagram),
            1e-7);
}

// What two formulas, or a formula and itself, need of the same is made once, and no amplifier stands idle.
TEST(TimeCircuit, MakesNothingTwice) {
  const auto elements = [](const std::string& formula, const std::string& other) {
    const std::string text = written(parsed(fmt::format(R"toml(
[run]
until = 6
[blocks]
u = {{ type = "time-function", formula = "{}" }}
v = {{ type = "time-function", formula = "{}" }}
[outputs]
u = "u"
v = "v"
)toml",
                                                        formula, other)));
    return fmt::format("{} integrators, {} summers, {} multipliers, {} comparators",
                       count(text, "type = \"integrator\""), count(text, "type = \"summer\""),
                       count(text, "type = \"multiplier\""), count(text, "type = \"comparator\""));
  };
  EXPECT_EQ(elements("step(time-1)*sin(2*time)", "step(time-1)"),
            "3 integrators, 0 summers, 1 multipliers, 1 comparators");
  EXPECT_EQ(elements("300*exp(-time/5)*sin(2*time)", "-2*exp(-time/5)*cos(2*time)"),
            "2 integrators, 0 summers, 0 multipliers, 0 comparators");
  EXPECT_EQ(elements("(0.5 + sin(time))^2", "7*(0.5 + sin(time))^2"),
            "2 integrators, 1 summers, 1 multipliers, 0 comparators");
  EXPECT_EQ(elements("if(time > 1, 5, 0)", "2*cos(3*time)*step(time - 1)"),
            "3 integrators, 0 summers, 1 multipliers, 1 comparators");
  EXPECT_EQ(elements("exp(-time)", "4*exp(-time) + 1"),
            "1 integrators, 1 summers, 0 multipliers, 0 comparators");
}

// A pulse of 1e-6 of the run: its area is 2·20·1e-6/e^(0.3·(10 − 7.3)) at the end.
TEST(TimeCircuit, MakesNarrowPulsesOfComparators) {
  const ScaledRealisation made = realise_scaled(integral_of("if(time > 7.3 and time < 7.30001, 20, 0)", 10),
                                                shipped_blocks(), desk_machine());
  const solve::Trajectory run = testing::trajectory_of(made.diagram);
  EXPECT_NEAR(run.at(run.rows() - 1, 1), 40e-5 * std::exp(-0.3 * 2.7), 40e-5 * 1e-4);
}

TEST(TimeCircuit, TakesAConstantForAReference) {
  for (const std::string block :
       {R"({ type = "time-function", formula = "0.5" })", R"({ type = "exponential", in = "0*one" })"}) {
    const diagram::Diagram diagram =
        parsed("[blocks]\none = { type = \"constant\" }\nu = " + block +
               "\nx = { type = \"integrator\", in = [\"u\", \"-x\"] }\n[outputs]\nx = \"x\"\n");
    const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), desk_machine());
    EXPECT_TRUE(made.functions.empty());
    EXPECT_LT(testing::difference(diagram, made.diagram), 1e-7) << block;
  }
}

// Peaks so narrow that the points by which lines are found do not see them were drawn as nothing.
TEST(TimeCircuit, RefusesPeaksThatNoLinesSee) {
  EXPECT_THAT(testing::message_of<RealiseError>([] {
                realise_scaled(integral_of("exp(-(1e4*sin(7*time))^2) + 0.2*time", 10), shipped_blocks(),
                               desk_machine());
              }),
              ::testing::HasSubstr("'u' (time-function)"));
}

// While the others hold, what stands for a formula of the time goes on.
TEST(TimeCircuit, GoesOnWhileOthersHold) {
  diagram::Diagram diagram = integral_of("sin(2*time)*exp(-time/4) + step(time - 1.5)", 4);
  const std::string phases = R"toml(
[timeline]
phases = [{ mode = "operate", for = 1 }, { mode = "hold", for = 1 }, { mode = "operate", for = 2 }]
)toml";
  diagram = parsed(
      "\n" + diagram::write_diagram(diagram).substr(std::string("format = \"oblique-diagram/1\"").size()) +
      phases);
  const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), desk_machine());
  EXPECT_LT(testing::difference(diagram, made.diagram), 1e-6);
}

}  // namespace
}  // namespace oblique::machine
