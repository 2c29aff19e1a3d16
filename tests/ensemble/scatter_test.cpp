// SPDX-License-Identifier: MIT
#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/ensemble/study/scatter.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::ensemble {
namespace {

using Words = std::array<std::uint32_t, 4>;

// The known answers that come with the authors' Random123 library.
TEST(Philox, GivesTheKnownAnswers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8}));
  EXPECT_EQ(philox({~0U, ~0U, ~0U, ~0U}, {~0U, ~0U}),
            (Words{0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD}));
  EXPECT_EQ(philox({0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344}, {0xA4093822, 0x299F31D0}),
            (Words{0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1}));
}

diagram::FlatDiagram two_summers_and_a_multiplier() {
  static const diagram::Diagram diagram = diagram::parse_diagram(testing::diagram_text(R"(
one = { type = "constant", value = 0.5 }
a   = { type = "summer", in = ["one"] }
b   = { type = "summer", in = ["-one"], tolerance = 0.01 }
ab  = { type = "multiplier", in = ["a", "b"] }
)"),
                                                                 "d.toml");
  return diagram::flatten(diagram, testing::shipped_blocks());
}

const std::vector<diagram::BlockFigure> kScatters{{"summer", "tolerance", 0.02, ""},
                                                  {"multiplier", "error", 0.3, ""}};

TEST(Scatter, IsUniformAboutWhatTheElementHas) {
  const diagram::FlatDiagram flat = two_summers_and_a_multiplier();
  constexpr int kRuns = 20'000;
  double sums[3] = {}, squares[3] = {}, product = 0, after_another = 0, last = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const std::vector<Draw> draws = draw(flat, kScatters, {5, run});
    ASSERT_EQ(draws.size(), 3U);
    const double values[] = {draws[0].value / 0.02, (draws[1].value - 0.01) / 0.02, draws[2].value / 0.3};
    for (int k = 0; k < 3; ++k) {
      ASSERT_LE(std::abs(values[k]), 1);
      sums[k] += values[k];
      squares[k] += values[k] * values[k];
    }
    product += values[0] * values[1];
    after_another += values[0] * last;
    last = values[0];
  }
  // Four standard deviations of a mean over the runs: of a variable on [−1, 1] 1/√3, of its square √(4/45),
  // of the product of two 1/3.
  const double root = std::sqrt(double{kRuns});
  for (const double sum : sums) EXPECT_NEAR(sum / kRuns, 0, 4 / std::sqrt(3) / root);
  for (const double square : squares) EXPECT_NEAR(square / kRuns, 1.0 / 3, 4 * std::sqrt(4.0 / 45) / root);
  EXPECT_NEAR(product / kRuns, 0, 4.0 / 3 / root);        // two elements know nothing of each other,
  EXPECT_NEAR(after_another / kRuns, 0, 4.0 / 3 / root);  // nor do two runs
}

TEST(Scatter, DependsOnTheKeyAlone) {
  const diagram::FlatDiagram flat = two_summers_and_a_multiplier();
  const auto value = [&](DrawKey key) { return draw(flat, kScatters, key).front().value; };
  EXPECT_EQ(value({5, 3}), value({5, 3}));
  EXPECT_NE(value({5, 3}), value({5, 4}));
  EXPECT_NE(value({5, 3}), value({6, 3}));
  EXPECT_NE(value({5, 3}), value({5 + (std::uint64_t{1} << 32), 3}));  // all of the seed counts,
  EXPECT_NE(value({5, 3}), value({5, 3 + (std::uint64_t{1} << 32)}));  // and all of the number
}

TEST(Scatter, ChangesTheEquationsOfWhatItTouches) {
  diagram::FlatDiagram flat = two_summers_and_a_multiplier();
  const diagram::Behaviour* const ideal = flat.blocks[3].behaviour;
  apply_draws(draw(flat, kScatters, {1, 0}), flat);
  EXPECT_NE(flat.blocks[3].behaviour, ideal);  // the case "error > 0"
  EXPECT_NE(flat.blocks[1].parameters[*flat.blocks[1].definition->find_parameter("tolerance")], 0);
}

TEST(Scatter, LeavesTheFormulasOfWhatItTouches) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("curve", R"toml([outputs]
out = {}
[parameters]
formula = { kind = "formula", default = "0" }
error = { default = 0, above = -1 }
[equations]
out = "formula*(1 + error)")toml");
  testing::Compiled made("c = { type = \"curve\", formula = \"3*time\" }\n", "", library);
  const std::vector<Draw> draws = draw(made.flat, {{"curve", "error", 0.3, ""}}, {1, 0});
  ASSERT_EQ(draws.size(), 1U);
  apply_draws(draws, made.flat);
  const network::Program program(network::assemble(made.flat));
  network::Workspace workspace(program);
  std::vector<double> signals(program.n_signals());
  program.signals(0.5, nullptr, signals.data(), workspace);
  EXPECT_DOUBLE_EQ(signals[made.signal("c")], 3 * 0.5 * (1 + draws[0].value));
}

TEST(Scatter, OfAToleranceTakesWeightsAndMultipliers) {
  const std::vector<diagram::BlockFigure> scatters = scatters_of_tolerance(testing::shipped_blocks(), 1e-3);
  std::vector<std::string> names;
  for (const diagram::BlockFigure& scatter : scatters) {
    names.push_back(scatter.block + "." + scatter.parameter);
    EXPECT_EQ(scatter.value, 1e-3);
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"integrator.tolerance", "inverter.tolerance", "multiplier.error",
                                             "potentiometer.tolerance", "summer.tolerance"}));
}

}  // namespace
}  // namespace oblique::ensemble
