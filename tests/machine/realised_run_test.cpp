// SPDX-License-Identifier: MIT
// Diagrams in a machine's elements move as they did before.
#include <algorithm>
#include <cctype>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/machine/realise.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/patch/patch.h>

#include "machine_runs.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::difference;
using testing::expect_machine_elements;
using testing::inverting_machine;
using testing::shipped_blocks;
using testing::signed_machine;

struct Case {
  std::string file;
  patch::PatchMethod method = patch::PatchMethod::triangles;
  double gain = 1e6;
};

std::string name_of(const ::testing::TestParamInfo<Case>& tested) {
  std::string name = tested.param.file + "_" + std::string(patch::method_name(tested.param.method));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class PatchedMechanism : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Realise, PatchedMechanism,
                         ::testing::Values(Case{"four-bar"}, Case{"slider-crank-offset"}, Case{"whitworth"},
                                           Case{"scotch-yoke"}, Case{"six-bar"}, Case{"jansen"},
                                           Case{"class-iii"},
                                           Case{"four-bar", patch::PatchMethod::gradient, 1e4},
                                           Case{"slider-crank", patch::PatchMethod::gradient, 1e4},
                                           Case{"class-iv", patch::PatchMethod::gradient, 1e4}),
                         name_of);

// The frozen equations are the same with signals inverted, so that only the solver's steps differ. Its
// tolerance of 1e-10 a step adds up over some hundred steps.
TEST_P(PatchedMechanism, MovesAsItDidOnAMachine) {
  patch::PatchOptions options;
  options.method = GetParam().method;
  options.gain = GetParam().gain;
  const diagram::Diagram diagram =
      patch::patch(mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" +
                                             GetParam().file + ".toml"),
                   options);
  for (const diagram::MachineProfile& machine : {inverting_machine(), signed_machine()}) {
    const diagram::Diagram made = realise(diagram, shipped_blocks(), machine).diagram;
    expect_machine_elements(made, machine.signed_coefficients);
    EXPECT_LT(difference(diagram, made), 1e-7) << diagram::write_diagram(made);
    EXPECT_TRUE(diagram::parse_diagram(diagram::write_diagram(made), "made.toml") == made);
  }
}

class ShippedDiagram : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Realise, ShippedDiagram,
                         ::testing::Values("lessons/circle", "lessons/damped-oscillator", "lessons/duffing",
                                           "lessons/bessel", "lessons/legendre", "lessons/pendulum",
                                           "lessons/division", "lessons/square-root", "lessons/triangle-sas",
                                           "lessons/triangle-side", "lessons/projectile",
                                           "lessons/pid-saturation", "lessons/inverse-sine",
                                           "historical/van-der-pol", "historical/heat-rod",
                                           "historical/lotka-volterra", "historical/nerve",
                                           "atlas/class-three-mechanism"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           for (char& c : name)
                             c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

// Lessons have tolerances of 1e-8 and limit cycles whose phase gathers the error.
TEST_P(ShippedDiagram, RunsAsItDidOnAMachine) {
  const diagram::Diagram diagram =
      diagram::read_diagram(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + GetParam() + ".toml");
  for (const diagram::MachineProfile& machine : {inverting_machine(), signed_machine()}) {
    const diagram::Diagram made = realise(diagram, shipped_blocks(), machine).diagram;
    expect_machine_elements(made, machine.signed_coefficients);
    EXPECT_LT(difference(diagram, made), 1e-5) << diagram::write_diagram(made);
  }
}

}  // namespace
}  // namespace oblique::machine
