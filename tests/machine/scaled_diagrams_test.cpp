// SPDX-License-Identifier: MIT
// Every shipped diagram in a machine's elements and scale: it gives what it gave, and every signal stays on
// the machine.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/machine/scaled_realisation.h>

#include "machine_runs.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::desk_machine;
using testing::expect_machine_elements;
using testing::greatest_signal;
using ::testing::HasSubstr;
using testing::shipped_blocks;

/// What becomes of a shipped diagram: it is realised, and its outputs then differ by at most `within` of the
/// largest of them, or it is refused with these words.
struct Fate {
  double within = 1e-7;
  std::string refused = {};
  double until = 0;  ///< [s] of the diagram, where a chaotic one is to be run for less than its own time
};

/// Integrators jump between phases, and a row may lie there: what these give is held by their `[expect]`
/// (`DiagramOnMachine.KeepsModesOfOperation`).
constexpr double kJumps = std::numeric_limits<double>::infinity();

// Ideal elements give the same frozen equations: what is left is the solver's tolerance of 1e-8 and what
// gathers of it over the run. A function generator of 200 lines is off by 1/(16·200²)·(∫√|f″|)² < 1e-5 of a
// smooth function, which the loops about it may enlarge.
const std::map<std::string, Fate> kFates = {
    {"lessons/aizawa", {1e-5, {}, 10}},
    {"lessons/double-pendulum", {1e-6}},
    {"lessons/inverse-sine", {1e-4}},
    {"lessons/iterative-operation", {kJumps}},
    {"lessons/logarithmic-multiplier", {1e-4}},
    {"lessons/oscilloscope-switch", {kJumps}},
    {"lessons/range-of-a-throw", {1e-4}},
    {"lessons/repetitive-operation", {kJumps}},
    {"lessons/sampled-regulator", {1e-4}},
    {"lessons/three-body", {1e-4, {}, 1}},
    {"lessons/triangle-aas", {1e-5}},
    {"lessons/triangle-asa", {1e-5}},
    {"lessons/triangle-sas", {1e-4}},
    {"lessons/triangle-side", {1e-4}},
    {"lessons/triangle-sss", {1e-4}},
    {"historical/chua", {1e-5, {}, 10}},
    {"historical/chua-piecewise", {1e-5, {}, 10}},
    {"historical/epidemic", {1e-4}},
    {"historical/lorenz", {1e-5, {}, 2}},
    {"historical/lotka-volterra", {1e-4}},
    {"historical/roessler", {1e-5, {}, 20}},
    {"historical/shooting", {kJumps}},
};

std::vector<std::string> shipped_diagrams() {
  std::vector<std::string> names;
  for (const std::string folder : {"lessons", "historical"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + folder))
      names.push_back(folder + "/" + entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class ScaledDiagram : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(ScaledRealisation, ScaledDiagram, ::testing::ValuesIn(shipped_diagrams()),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           for (char& c : name)
                             c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

TEST_P(ScaledDiagram, GivesOnAMachineWhatItGave) {
  const auto known = kFates.find(GetParam());
  const Fate fate = known == kFates.end() ? Fate() : known->second;
  diagram::Diagram diagram =
      diagram::read_diagram(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + GetParam() + ".toml");
  if (fate.until > 0) {
    diagram.run.until = fate.until;
    diagram.expectations.clear();
  }
  diagram.machine.profile = "ideal";
  ScalingOptions options;
  options.segments = 200;
  ScaledRealisation made;
  try {
    made = realise_scaled(diagram, shipped_blocks(), desk_machine(), options);
  } catch (const RealiseError& error) {
    EXPECT_NE(fate.refused, "") << error.what();
    EXPECT_THAT(error.what(), HasSubstr(fate.refused));
    fmt::print("{:30} refused: {}\n", GetParam(), error.diagnostics().front().what);
    return;
  }
  ASSERT_EQ(fate.refused, "") << "it is realised";
  expect_machine_elements(made.diagram, false);
  EXPECT_LE(greatest_signal(made.diagram), 1 + 1e-5);
  const double difference = testing::difference(diagram, made.diagram);
  EXPECT_LT(difference, fate.within) << diagram::write_diagram(made.diagram);
  const auto least =
      std::min_element(made.scales.begin(), made.scales.end(),
                       [](const SignalScale& a, const SignalScale& b) { return a.largest < b.largest; });
  fmt::print("{:30} {:3} blocks, 1 s in {:g} s, signals to {:.3f} ('{}') or more, outputs within {:.1e}\n",
             GetParam(), made.diagram.blocks.size(), made.time, least->largest, least->signal, difference);
  EXPECT_TRUE(diagram::parse_diagram(diagram::write_diagram(made.diagram), "made.toml") == made.diagram);
}

}  // namespace
}  // namespace oblique::machine
