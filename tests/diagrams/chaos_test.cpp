// SPDX-License-Identifier: MIT
// The chaotic diagrams, started where they do not move: at an equilibrium, which has a closed form.
#include <array>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

namespace oblique::test {
namespace {

struct Equilibrium {
  std::string name;
  std::string file;
  double x, y, z;     ///< in the problem's own units
  double sx, sy, sz;  ///< what 1 machine unit is worth
  double until;       ///< [s]
  double growth;      ///< at most this much does a deviation grow until then

  friend std::ostream& operator<<(std::ostream& out, const Equilibrium& e) { return out << e.name; }
};

/// c + a z − z³/3 = 0 for a = 0.95, c = 0.6, by Cardano's formula in its trigonometric form.
double aizawa_height() {
  constexpr double kA = 0.95, kC = 0.6;  // z³ − 3 a z − 3 c = 0: z = 2√a cos(θ/3), cos θ = 3 c/(2 a^(3/2))
  return 2 * std::sqrt(kA) * std::cos(std::acos(3 * kC / (2 * std::pow(kA, 1.5))) / 3);
}

const double kLorenz = std::sqrt(8.0 / 3 * 27);
const double kChua = std::sqrt(0.143);
const double kRoessler =
    (5.7 - std::sqrt(5.7 * 5.7 - 4 * 0.2 * 0.2)) / 2;  // x = −a y = a z, z² a − c z + b = 0

// Growth: exp(λ until) of the fastest eigenvalue there, and some ten times that where it is not a normal
// matrix.
const std::vector<Equilibrium> kEquilibria{
    {"LorenzAtRest", "historical/lorenz", 0, 0, 0, 25, 30, 50, 1, 1e6},  // λ = 11.83: exp 11.83 = 1.4e5
    {"LorenzRollingRight", "historical/lorenz", kLorenz, kLorenz, 27, 25, 30, 50, 10, 30},  // 0.094
    {"LorenzRollingLeft", "historical/lorenz", -kLorenz, -kLorenz, 27, 25, 30, 50, 10, 30},
    {"Roessler", "historical/roessler", kRoessler, -kRoessler / 0.2, kRoessler / 0.2, 12, 12, 24, 20,
     100},                                                                       // 0.097
    {"ChuaLeft", "historical/chua", -kChua, 0, kChua, 0.6, 0.1, 0.8, 10, 1000},  // 0.2
    {"ChuaRight", "historical/chua", kChua, 0, -kChua, 0.6, 0.1, 0.8, 10, 1000},
    {"Aizawa", "lessons/aizawa", 0, 0, aizawa_height(), 1.6, 1.6, 2, 10,
     10},  // stable along the axis, which it cannot leave
};

class ChaoticDiagram : public ::testing::TestWithParam<Equilibrium> {};
INSTANTIATE_TEST_SUITE_P(Chaos, ChaoticDiagram, ::testing::ValuesIn(kEquilibria),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(ChaoticDiagram, StaysAtItsEquilibrium) {
  const Equilibrium& e = GetParam();
  diagram::Diagram diagram =
      diagram::read_diagram(fmt::format("{}/diagrams/{}.toml", OBLIQUE_SOURCE_DIR, e.file));
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library,
                                                     {{"x.initial", fmt::format("{}", e.x / e.sx)},
                                                      {"y.initial", fmt::format("{}", e.y / e.sy)},
                                                      {"z.initial", fmt::format("{}", e.z / e.sz)}});
  solve::RunOptions options = solve::options_of(diagram.run);
  options.until = e.until;
  const oblique::solve::Run result = solve::run(network::Program(network::assemble(flat)), flat, options);
  const solve::Trajectory& run = result.trajectory;
  // The rounding of the start, and of some hundred evaluations since, grown.
  const double allowed = 1e-13 * e.growth * (1 + std::abs(e.x) + std::abs(e.y) + std::abs(e.z));
  for (std::size_t row = 0; row < run.rows(); ++row) {
    EXPECT_NEAR(run.at(row, run.find("x").value()), e.x, allowed);
    EXPECT_NEAR(run.at(row, run.find("y").value()), e.y, allowed);
    EXPECT_NEAR(run.at(row, run.find("z").value()), e.z, allowed);
  }
}

std::size_t state_of(const network::Program& program, std::string_view name) {
  for (std::size_t i = 0; i < program.n_states(); ++i) {
    if (program.states()[i].name == name) return i;
  }
  throw std::out_of_range(std::string(name));
}

class DeviationCircuit : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Chaos, DeviationCircuit,
                         ::testing::Values("historical_lorenz", "historical_roessler", "historical_chua",
                                           "lessons_aizawa"),
                         [](const auto& tested) { return tested.param; });

/// e′ = J e − (e·J e) e with the J of the Program, which is derived from the equations and not wired.
TEST_P(DeviationCircuit, IsTheLinearisation) {
  std::string file = GetParam();
  file[file.find('_')] = '/';
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::FlatDiagram flat = diagram::flatten(
      diagram::read_diagram(fmt::format("{}/diagrams/{}.toml", OBLIQUE_SOURCE_DIR, file)), library);
  const network::Program program(network::assemble(flat));
  network::Workspace workspace(program);
  const std::array<std::size_t, 3> x{state_of(program, "x"), state_of(program, "y"), state_of(program, "z")};
  const std::array<std::size_t, 3> e{state_of(program, "e1"), state_of(program, "e2"),
                                     state_of(program, "e3")};
  std::vector<double> states(program.n_states()), slopes(program.n_states());
  const network::SparsePattern& pattern = program.jacobian_pattern();
  std::vector<double> entries(pattern.entries());
  for (const auto& at : {std::array{0.3, -0.5, 0.7}, std::array{-0.8, 0.2, 0.4}}) {
    for (const auto& deviation : {std::array{0.6, -0.48, 0.64}, std::array{0.0, 0.6, 0.8}}) {
      for (std::size_t i = 0; i < 3; ++i) {
        states[x[i]] = at[i];
        states[e[i]] = deviation[i];
      }
      ASSERT_TRUE(program.derivatives(0, states.data(), slopes.data(), workspace));
      ASSERT_TRUE(program.jacobian(0, states.data(), entries.data(), workspace));
      std::array<double, 3> product{};
      for (std::size_t j = 0; j < 3; ++j) {
        for (auto k = pattern.column_starts[x[j]]; k < pattern.column_starts[x[j] + 1]; ++k) {
          for (std::size_t i = 0; i < 3; ++i) {
            const auto entry = static_cast<std::size_t>(k);
            if (static_cast<std::size_t>(pattern.rows[entry]) == x[i])
              product[i] += entries[entry] * deviation[j];
          }
        }
      }
      const double growth = product[0] * deviation[0] + product[1] * deviation[1] + product[2] * deviation[2];
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(slopes[e[i]], product[i] - growth * deviation[i], 1e-12) << i;  // rounding
      }
    }
  }
}

}  // namespace
}  // namespace oblique::test
