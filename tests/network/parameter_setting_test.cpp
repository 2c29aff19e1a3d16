// SPDX-License-Identifier: MIT
// Programs whose parameters were set, against those that are compiled with these parameters: the same numbers
// to the last bit.
#include <oblique/network/program/parameter_setting.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include <oblique/network/assembly/parameter_numbers.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using Vector = std::vector<double>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The number of a parameter of a block.
std::uint32_t number_of(const diagram::FlatDiagram& flat, std::string_view block, std::string_view name) {
  for (std::size_t b = 0; b < flat.blocks.size(); ++b) {
    if (flat.blocks[b].path == block)
      return ParameterNumbers(flat).parameter(b, flat.blocks[b].definition->find_parameter(name).value());
  }
  throw std::out_of_range(std::string(block));
}

/// All that a program computes at one place: nothing where it has no value there.
Vector values_of(const Program& program) {
  Vector all = program.start(), x = all;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.01 * static_cast<double>(i % 7 + 1);
  Workspace workspace(program);
  Vector derivatives(program.n_states()), signals(program.n_signals()),
      jacobian(program.jacobian_pattern().entries()), switches(program.switches().size());
  if (!program.derivatives(0.3, x.data(), derivatives.data(), workspace)) return all;
  program.jacobian(0.3, x.data(), jacobian.data(), workspace);
  const auto events = program.event_functions(0.3, x.data(), switches.data(), workspace);
  if (events && !switches.empty()) {
    Vector rates(switches.size());
    events->event_function_rates(derivatives.data(), rates.data());
    switches.insert(switches.end(), rates.begin(), rates.end());
  }
  program.signals(0.3, x.data(), signals.data(), workspace);
  for (const Vector* part : {&derivatives, &jacobian, &switches, &signals})
    all.insert(all.end(), part->begin(), part->end());
  return all;
}

bool same(const Vector& a, const Vector& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double left, double right) {
    return left == right || (std::isnan(left) && std::isnan(right));
  });
}

TEST(ParameterSetting, FollowsThroughWhatIsMadeOfAParameter) {
  // 2·0.5 x, then 2·0.25 x: the coefficient and the weight are one constant of the equations.
  const Compiled made(
      "p = { type = \"potentiometer\", in = \"x\", setting = 0.5 }\n"
      "x = { type = \"integrator\", in = \"-3*p\", initial = 1 }\n");
  ParameterSetting setting(made.program);
  const ParameterSetting::Parameter quarter{number_of(made.flat, "p", "setting"), 0.25};
  ASSERT_TRUE(setting.set({&quarter, 1}));
  const Program turned(made.program, setting);
  const double x = 1;
  double derivative = 0;
  Workspace workspace(turned), before(made.program);
  ASSERT_TRUE(turned.derivatives(0, &x, &derivative, workspace));
  EXPECT_EQ(derivative, -0.75);
  ASSERT_TRUE(made.program.derivatives(0, &x, &derivative, before));
  EXPECT_EQ(derivative, -1.5) << "the program it was made of is as it was";
}

TEST(ParameterSetting, SetsWhereAStateBegins) {
  const Compiled made("x = { type = \"integrator\", in = \"-x\", initial = 0.3 }\n");
  ParameterSetting setting(made.program);
  const ParameterSetting::Parameter other{number_of(made.flat, "x", "initial"), -0.7};
  EXPECT_FALSE(setting.set({&other, 1})) << "another sign is another kind";
  const ParameterSetting::Parameter half{other.number, 0.5};
  ASSERT_TRUE(setting.set({&half, 1}));
  EXPECT_EQ(Program(made.program, setting).start(), Vector{0.5});
}

// 0 and 1 leave factors out, 2 makes a square, infinity is another amplifier: not the same equations.
TEST(ParameterSetting, RefusesWhatMakesOtherEquations) {
  const Compiled made(
      "p = { type = \"potentiometer\", in = \"x\", setting = 0.5 }\n"
      "x = { type = \"integrator\", in = \"-3*p\", initial = 1 }\n");
  const Vector before = values_of(made.program);
  for (const double value : {0.0, 1.0, -1.0, 2.0, -0.5, kInfinity, std::nan("")}) {
    ParameterSetting setting(made.program);
    const ParameterSetting::Parameter other{number_of(made.flat, "p", "setting"), value};
    EXPECT_FALSE(setting.set({&other, 1})) << value;
    EXPECT_TRUE(same(values_of(Program(made.program, setting)), before)) << "it is put back";
  }
}

// Of every parameter of every shipped diagram, and the weights of its wires.
TEST(ParameterSetting, AgreesWithCompilingAnew) {
  int at_once = 0, anew = 0;
  for (const char* const folder : {"lessons", "historical"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + folder)) {
      if (entry.path().extension() != ".toml") continue;
      const diagram::FlatDiagram flat =
          diagram::flatten(diagram::read_diagram(entry.path()), testing::shipped_blocks());
      if (flat.blocks.size() > 60) continue;  // for the time it takes
      const ParameterNumbers numbers(flat);
      const Program base(assemble(flat));
      const Vector was = parameter_values(flat);
      ASSERT_EQ(was.size(), numbers.size());
      const auto look = [&](diagram::FlatDiagram other, std::uint32_t number, double value,
                            const diagram::Behaviour* behaviour, std::size_t b) {
        other.blocks[b].choose_behaviour();
        if (other.blocks[b].formulas.empty() && other.blocks[b].behaviour != behaviour) return;
        ParameterSetting setting(base);
        const ParameterSetting::Parameter parameter{number, value};
        const bool set = setting.set({&parameter, 1});
        ++(set ? at_once : anew);
        std::optional<Program> compiled;
        try {
          compiled.emplace(assemble(other));
        } catch (const NetworkError&) {
          EXPECT_FALSE(set) << entry.path() << " " << other.blocks[b].path;
          return;
        }
        if (!set) return;
        EXPECT_EQ(compiled->n_instructions(), base.n_instructions());
        EXPECT_TRUE(same(values_of(Program(base, setting)), values_of(*compiled)))
            << entry.path() << ": number " << number << ", in " << other.blocks[b].path;
      };
      for (std::size_t b = 0; b < flat.blocks.size(); ++b) {
        const diagram::FlatBlock& block = flat.blocks[b];
        for (std::size_t k = 0; k < block.parameters.size(); ++k) {
          for (const double factor : {1.25, 0.0, -1.0}) {
            diagram::FlatDiagram other = flat;
            double& value = other.blocks[b].parameters[k];
            value = factor == 0 ? 0.3 : factor * value;
            if (value == block.parameters[k]) continue;
            const double to = value;
            look(std::move(other), numbers.parameter(b, k), to, block.behaviour, b);
          }
        }
        for (std::size_t input = 0; input < block.inputs.size(); ++input) {
          for (std::size_t wire = 0; wire < block.inputs[input].terms.size(); ++wire) {
            diagram::FlatDiagram other = flat;
            const double to = other.blocks[b].inputs[input].terms[wire].weight *= 1.7;
            look(std::move(other), numbers.weight(b, input, wire), to, block.behaviour, b);
          }
        }
      }
    }
  }
  EXPECT_GT(at_once, 500);
  EXPECT_GT(anew, 100);
}

}  // namespace
}  // namespace oblique::network
