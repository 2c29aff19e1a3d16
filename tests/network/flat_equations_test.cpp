// SPDX-License-Identifier: MIT
// The equations in one piece, with parameters that are held, against programs that are compiled with these
// parameters and solve their loops.
#include <oblique/network/program/flat_equations.h>

#include <cmath>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/parameter_prologue.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using Vector = std::vector<double>;

// All weights and parameters of blocks that are no whole numbers, and so are surely no counts.
std::vector<std::uint32_t> varied_of(const diagram::FlatDiagram& flat) {
  const Vector values = parameter_values(flat);
  const ParameterNumbers numbers(flat);
  std::vector<std::uint32_t> varied;
  for (std::size_t b = 0; b < flat.blocks.size(); ++b) {
    for (std::size_t p = 0; p < flat.blocks[b].parameters.size(); ++p) {
      const std::uint32_t number = numbers.parameter(b, p);
      if (std::isfinite(values[number]) && values[number] != std::round(values[number]))
        varied.push_back(number);
    }
  }
  return varied;
}

struct Flat {
  std::vector<std::uint32_t> varied;
  Program program;
  FlatEquations equations;
  ParameterPrologue prologue;

  explicit Flat(const diagram::FlatDiagram& flat)
      : varied(varied_of(flat)),
        program(assemble(flat, varied)),
        equations(flat_equations(program, signals_of(program, flat))),
        prologue(program, varied) {}

  static std::vector<std::size_t> signals_of(const Program& program, const diagram::FlatDiagram& flat) {
    std::vector<std::size_t> signals;
    for (const diagram::FlatOutput& output : flat.outputs)
      signals.push_back(program.signal_index(output.signal));
    return signals;
  }
};

// What F, its derivatives and the outputs are at t and u, in slots.
Vector evaluated(const FlatEquations& equations, Vector slots, double t, const Vector& states,
                 const Vector& unknowns) {
  slots[0] = t;
  std::copy(states.begin(), states.end(), slots.begin() + 1);
  for (std::size_t k = 0; k < equations.unknowns.size(); ++k)
    slots[1 + states.size() + equations.unknowns[k]] = unknowns[k];
  run_tape(equations.rates, slots.data());
  run_tape(equations.derivatives, slots.data());
  run_tape(equations.outputs, slots.data());
  return slots;
}

// Compares at some places near the start; gives the number of places.
int compare(const diagram::FlatDiagram& flat, const std::string& name, std::mt19937& random) {
  const Flat held(flat);
  const FlatEquations& equations = held.equations;
  std::uniform_real_distribution<double> part(-1, 1);
  Vector values = parameter_values(flat);
  Vector drawn;
  for (const std::uint32_t number : held.varied) drawn.push_back(values[number] * (1 + 0.01 * part(random)));
  diagram::FlatDiagram other = flat;
  set_parameters(other, ParameterNumbers(flat), held.varied, drawn);
  const Program program(assemble(other));
  Vector scratch(held.prologue.scratch_size()), constants(held.prologue.slots().size());
  if (!held.prologue.run(drawn, scratch, constants)) return 0;
  Vector slots = equations.initial_slots;
  for (std::size_t k = 0; k < constants.size(); ++k) slots[held.prologue.slots()[k]] = constants[k];

  Workspace workspace(program), held_workspace(held.program);
  const std::size_t n = program.n_states();
  EXPECT_EQ(n, equations.n_states) << name;
  Vector rates(n), signals(program.n_signals());
  int places = 0;
  for (int k = 0; k < 3; ++k) {
    Vector x = program.start();
    for (double& state : x) state += 0.01 * part(random);
    const double t = 0.1 + 0.2 * k;
    if (!program.derivatives(t, x.data(), rates.data(), workspace)) continue;
    program.signals(t, x.data(), signals.data(), workspace);
    Vector unknowns;
    for (const std::uint32_t u : equations.unknowns) unknowns.push_back(workspace.unknown(u));
    const Vector found = evaluated(equations, slots, t, x, unknowns);
    const auto f = [&](std::size_t row) { return found[equations.rate_slots[row]]; };
    double largest = 1;
    for (const double rate : rates) largest = std::max(largest, std::abs(rate));
    for (std::size_t i = 0; i < n; ++i) {
      // the same sums in another order, of terms that may be 1e8 times their result
      EXPECT_NEAR(f(i), rates[i], 1e-9 * largest) << name << " rate " << i;
    }
    for (std::size_t o = 0; o < flat.outputs.size(); ++o) {
      const double truth = signals[program.signal_index(flat.outputs[o].signal)];
      EXPECT_NEAR(found[equations.output_slots[o]], truth, 1e-9 * (1 + std::abs(truth))) << name;
    }
    // The derivatives by differences of F, whose error is of the order of 1e-6 of the largest entry.
    std::vector<Vector> matrix(equations.n_variables, Vector(equations.n_variables));
    double steepest = 1;
    for (const MatrixEntry& entry : equations.jacobian) {
      matrix[entry.row][entry.column] += found[entry.slot];
      steepest = std::max(steepest, std::abs(matrix[entry.row][entry.column]));
    }
    constexpr double h = 1e-6;
    for (std::size_t column = 0; column < equations.n_variables; ++column) {
      const auto moved = [&](double by) {
        Vector states = x, loops = unknowns;
        (column < n ? states[column] : loops[column - n]) += by;
        return evaluated(equations, slots, t, states, loops);
      };
      const Vector more = moved(h), less = moved(-h);
      for (std::size_t row = 0; row < equations.n_variables; ++row) {
        const std::uint32_t slot = equations.rate_slots[row];
        EXPECT_NEAR(matrix[row][column], (more[slot] - less[slot]) / (2 * h), 1e-5 * steepest)
            << name << " row " << row << " column " << column;
      }
    }
    Vector by_time(equations.n_variables);
    for (const auto& [row, slot] : equations.by_time) by_time[row] += found[slot];
    const Vector later = evaluated(equations, slots, t + h, x, unknowns),
                 earlier = evaluated(equations, slots, t - h, x, unknowns);
    for (std::size_t row = 0; row < equations.n_variables; ++row) {
      const std::uint32_t slot = equations.rate_slots[row];
      EXPECT_NEAR(by_time[row], (later[slot] - earlier[slot]) / (2 * h), 1e-5 * steepest)
          << name << " row " << row;
    }
    ++places;
  }
  return places;
}

TEST(FlatEquations, AreThoseOfTheProgramThatIsCompiledWithTheValues) {
  std::mt19937 random(5);
  int places = 0, diagrams = 0;
  for (const char* folder : {"/diagrams/lessons", "/diagrams/historical"}) {
    for (const auto& entry : std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + folder)) {
      if (entry.path().extension() != ".toml") continue;
      const diagram::Diagram diagram = diagram::read_diagram(entry.path());
      const diagram::FlatDiagram flat = diagram::flatten(diagram, testing::shipped_blocks());
      const Program program(assemble(flat));
      if (!program.switches().empty() || !program.discrete_states().empty()) continue;
      try {
        places += compare(flat, entry.path().filename().string(), random);
        ++diagrams;
      } catch (const NetworkError&) {  // an output of a loop beside the states: below
      }
    }
  }
  EXPECT_GE(diagrams, 25);
  EXPECT_GE(places, 60);
}

// A loop that the rates need: its unknown is a variable, whose row of F is the residual.
TEST(FlatEquations, UnknownsOfLoopsAreVariables) {
  const Compiled compiled(R"(
      s = { type = "summer", in = ["x", "-0.5*p"] }
      p = { type = "summer", in = ["0.8*s", "y"] }
      x = { type = "integrator", in = ["-1*s"], initial = 0.3 }
      y = { type = "integrator", in = ["-0.7*p"], initial = 0.4 }
      )",
                          "\n[outputs]\np = \"p\"\n");
  std::mt19937 random(1);
  EXPECT_EQ(Flat(compiled.flat).equations.n_variables, 3U);
  EXPECT_EQ(compare(compiled.flat, "loop", random), 3);
}

TEST(FlatEquations, AnOutputOfALoopBesideTheStatesIsRefused) {
  const Compiled compiled(R"(
      x      = { type = "integrator", in = ["0.9*one"], initial = 0.1 }
      one    = { type = "constant" }
      root   = { type = "servo-amplifier", in = ["square", "-x"], gain = 1e8, bandwidth = inf, initial = 1 }
      square = { type = "squarer", in = "root" }
      twice  = { type = "summer", in = ["2*root"] }
      )",
                          "\n[outputs]\nx = \"x\"\n");
  for (const char* output : {"root", "twice"}) {
    const std::size_t signals[] = {compiled.signal(output)};
    EXPECT_EQ(testing::message_of<NetworkError>([&] { flat_equations(compiled.program, signals); }),
              "an output follows 'root', of a loop that no state depends on");
  }
  const std::size_t signals[] = {compiled.signal("x")};
  EXPECT_EQ(flat_equations(compiled.program, signals).n_variables, 1U);
}

}  // namespace
}  // namespace oblique::network
