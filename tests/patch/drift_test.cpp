// SPDX-License-Identifier: MIT
// What a patch does in its third turn.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>

namespace oblique::patch {
namespace {

class ThirdTurn : public ::testing::TestWithParam<std::pair<const char*, PatchMethod>> {};
INSTANTIATE_TEST_SUITE_P(Patch, ThirdTurn,
                         ::testing::Values(std::pair("four-bar", PatchMethod::triangles),
                                           std::pair("four-bar", PatchMethod::gradient),
                                           std::pair("six-bar", PatchMethod::triangles),
                                           std::pair("class-iii", PatchMethod::triangles)));

TEST_P(ThirdTurn, IsLikeTheFirst) {
  const auto& [name, method] = GetParam();
  const mechanism::Mechanism mechanism =
      mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name + ".toml");
  constexpr std::size_t kRows = 91;  // of a turn, one end of it
  PatchOptions options;
  options.method = method;
  options.samples = 3 * (kRows - 1) + 1;
  diagram::Diagram diagram = patch(mechanism, options);
  const double turn = mechanism::period(mechanism);
  diagram.run.until = 3 * turn;
  diagram.outputs.push_back({"cos", mechanism.drives.front().name + ".cos", 1, "1", {}, 0});
  diagram.outputs.push_back({"sin", mechanism.drives.front().name + ".sin", 1, "1", {}, 0});
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  const network::Program program(network::assemble(flat));
  const auto result = solve::run(program, flat, solve::options_of(diagram.run));
  const solve::Trajectory& table = result.trajectory;
  const std::size_t cosine = table.find("cos").value(), sine = table.find("sin").value();
  // no drift of amplitude and phase beyond 1e-6: what the tolerance of 1e-10 leaves over some thousand steps
  constexpr double kDrift = 1e-6;
  const mechanism::Drive& drive = mechanism.drives.front();
  const double size = mechanism.largest_length();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double angle = drive.start + drive.speed * table.at(row, 0);
    EXPECT_NEAR(table.at(row, cosine), std::cos(angle), kDrift);
    EXPECT_NEAR(table.at(row, sine), std::sin(angle), kDrift);
    EXPECT_NEAR(std::hypot(table.at(row, cosine), table.at(row, sine)), 1, kDrift);
    if (row < kRows) continue;
    for (const mechanism::Point& point : mechanism.points) {
      if (point.fixed) continue;
      for (const char* axis : {".x", ".y"}) {
        const std::size_t column = table.find(point.name + axis).value();
        EXPECT_NEAR(table.at(row, column), table.at(row - (kRows - 1), column), kDrift * size)
            << point.name << axis;
      }
    }
  }
}

}  // namespace
}  // namespace oblique::patch
