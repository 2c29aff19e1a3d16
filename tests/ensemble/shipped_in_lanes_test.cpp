// SPDX-License-Identifier: MIT
// All shipped diagrams and mechanisms that run in lanes, against CVODES.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/ensemble/engine/ensemble.h>
#include <oblique/ensemble/study/scatter.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/patch/patch.h>

#include "../support/compiled.h"

namespace oblique::ensemble {
namespace {

constexpr std::uint64_t kMachines = 5;
constexpr double kTolerance = 1e-6;

struct Shipped {
  diagram::FlatDiagram flat;
  std::vector<DrawnElement> drawn;
  std::vector<std::uint32_t> varied;
  EnsembleOptions options;

  explicit Shipped(const diagram::Diagram& diagram)
      : flat(diagram::flatten(diagram, testing::shipped_blocks())) {
    drawn = drawn_elements(flat, scatters_of_tolerance(testing::shipped_blocks(), 1e-3));
    const network::ParameterNumbers numbers(flat);
    for (const DrawnElement& element : drawn)
      varied.push_back(numbers.parameter(element.block, element.parameter));
    options.run = solve::options_of(diagram.run);
    options.run.samples = 37;
    for (diagram::FlatOutput& output : flat.outputs) output.scale = 1, output.offset = 0;
  }

  std::vector<std::vector<double>> run(bool lanes, double tolerance, EnsembleCount& count) const {
    EnsembleOptions how = options;
    how.lanes = lanes;
    how.run.tolerance = tolerance;
    how.run.absolute_tolerance.reset();
    diagram::FlatDiagram typical = flat;
    apply_draws(draw(flat, scatters_of_tolerance(testing::shipped_blocks(), 1e-3), {1, 0}), typical);
    std::vector<std::vector<double>> rows(kMachines);
    count =
        Ensemble(typical, varied, how)
            .run(
                0, kMachines,
                [&](std::uint64_t k, std::span<double> values) {
                  for (std::size_t e = 0; e < drawn.size(); ++e)
                    values[e] = drawn[e].draw(
                        flat, flat.blocks[drawn[e].block].parameters[drawn[e].parameter], {1, k});
                },
                [&](const MachineRun& run) { rows[run.number].assign(run.rows.begin(), run.rows.end()); });
    return rows;
  }
};

double largest_error(const std::vector<std::vector<double>>& rows,
                     const std::vector<std::vector<double>>& truth) {
  double largest = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (truth[k].empty() || rows[k].empty()) continue;
    for (std::size_t i = 0; i < truth[k].size(); ++i)
      largest = std::max(largest, std::abs(rows[k][i] - truth[k][i]) / std::max(1.0, std::abs(truth[k][i])));
  }
  return largest;
}

// The error of the lanes at a tolerance against CVODES a thousand times finer, beside the error of CVODES at
// the same tolerance. Where a solution amplifies errors (a chaotic one, a long one) both do; so the bound is
// five times CVODES' error, or five times the tolerance.
int compare(const diagram::Diagram& diagram, const std::string& name) {
  const Shipped shipped(diagram);
  EnsembleCount count, other;
  const auto lanes = shipped.run(true, kTolerance, count);
  if (count.in_lanes == 0) return 0;
  const auto truth = shipped.run(false, kTolerance / 1000, other);
  const auto same = shipped.run(false, kTolerance, other);
  const double error = largest_error(lanes, truth), of_cvodes = largest_error(same, truth);
  EXPECT_LE(error, 5 * std::max(of_cvodes, kTolerance)) << name << ": CVODES " << of_cvodes;
  return 1;
}

TEST(ShippedInLanes, DiagramsAreAsExactAsByCvodes) {
  int in_lanes = 0;
  for (const char* folder : {"/diagrams/lessons", "/diagrams/historical"}) {
    for (const auto& entry : std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + folder)) {
      if (entry.path().extension() != ".toml") continue;
      diagram::Diagram diagram = diagram::read_diagram(entry.path());
      // Chaos makes any error whole in the end; some swings are enough, and take less time.
      const std::string name = entry.path().stem().string();
      if (name == "lorenz" || name == "chua" || name == "roessler" || name == "circle")
        diagram.run.until /= 20;
      in_lanes += compare(diagram, name);
    }
  }
  const std::string circuit = "/diagrams/atlas/class-three-mechanism.toml";
  in_lanes += compare(diagram::read_diagram(OBLIQUE_SOURCE_DIR + circuit), circuit);
  EXPECT_GE(in_lanes, 22);  // the others have switches, tables, events
}

TEST(ShippedInLanes, MechanismsAreAsExactAsByCvodes) {
  int in_lanes = 0;
  const std::filesystem::path folder = OBLIQUE_SOURCE_DIR "/diagrams/mechanisms";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    diagram::Diagram patched;
    try {
      patched = patch::patch(mechanism::read_mechanism(entry.path()), {});
    } catch (const text::Error&) {
      continue;  // only by gradient, or not at all
    }
    in_lanes += compare(patched, entry.path().stem().string());
  }
  EXPECT_GE(in_lanes, 32);
}

}  // namespace
}  // namespace oblique::ensemble
