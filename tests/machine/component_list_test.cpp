// SPDX-License-Identifier: MIT
#include <oblique/machine/component_list.h>

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>

#include "../support/compiled.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using ::testing::ElementsAre;
using testing::inverting_machine;
using testing::shipped_blocks;
using testing::signed_machine;

ComponentList components(const std::string& blocks, const diagram::MachineProfile& machine) {
  return component_list_of(
      diagram::flatten(diagram::parse_diagram(testing::diagram_text(blocks), "d.toml"), shipped_blocks()),
      machine);
}

const ComponentListRow& row(const ComponentList& components, const std::string& element) {
  const auto found = std::find_if(components.rows.begin(), components.rows.end(),
                                  [&](const ComponentListRow& r) { return r.element == element; });
  if (found == components.rows.end()) throw std::out_of_range(element);
  return *found;
}

void set_count(diagram::MachineProfile& machine, diagram::ElementKind kind, std::optional<double> count) {
  std::erase_if(machine.elements, [&](const diagram::ElementCount& e) { return e.kind == kind; });
  machine.elements.push_back({kind, count, {}});
}

void remove(diagram::MachineProfile& machine, diagram::ElementKind kind) {
  std::erase_if(machine.elements, [&](const diagram::ElementCount& e) { return e.kind == kind; });
}

// An oscillator of two integrators and an inverter, with a servo amplifier and a product besides.
const char* const kListedBlocks = R"(
x = { type = "integrator", in = ["y"], initial = 1 }
y = { type = "integrator", in = ["n"] }
n = { type = "inverter", in = "x" }
s = { type = "summer", in = ["x", "10*p"] }
p = { type = "potentiometer", in = "y", setting = 0.2 }
q = { type = "servo-amplifier", in = ["m", "x"] }
m = { type = "multiplier", in = ["q", "q"] }
)";

TEST(ComponentList, CountsEveryUncommittedAmplifierAndTheNetworksOfIntegrators) {
  const ComponentList counted = components(kListedBlocks, inverting_machine());
  EXPECT_EQ(row(counted, "amplifiers").needed, 5);
  EXPECT_EQ(row(counted, "amplifiers").note, "1 summer, 1 inverter, 2 integrators, 1 open amplifier");
  EXPECT_EQ(row(counted, "integrator networks").needed, 2);
  EXPECT_EQ(row(counted, "potentiometers").needed, 1);
  EXPECT_EQ(row(counted, "multipliers").needed, 1);
  EXPECT_EQ(counted.rows.size(), 4U);
  EXPECT_EQ(counted.verdict(), ComponentList::Verdict::fits);
}

TEST(ComponentList, TakesSummersForOpenAmplifiersAndForInvertersBeyondThoseThereAre) {
  diagram::MachineProfile machine = inverting_machine();
  remove(machine, diagram::ElementKind::amplifier);
  set_count(machine, diagram::ElementKind::integrator, 2);
  set_count(machine, diagram::ElementKind::summer, 3);
  ComponentList counted = components(kListedBlocks, machine);  // without inverters of its own
  EXPECT_EQ(row(counted, "integrators").needed, 2);
  EXPECT_EQ(row(counted, "summers").needed, 3);
  EXPECT_EQ(row(counted, "summers").note, "1 open amplifier, 1 inverter of these");
  EXPECT_EQ(counted.verdict(), ComponentList::Verdict::fits);
  set_count(machine, diagram::ElementKind::inverter, 4);
  counted = components(kListedBlocks, machine);
  EXPECT_EQ(row(counted, "summers").needed, 2);
  EXPECT_EQ(row(counted, "inverters").needed, 1);
}

TEST(ComponentList, SaysWhatIsMissing) {
  diagram::MachineProfile machine = inverting_machine();
  set_count(machine, diagram::ElementKind::amplifier, 3);
  const ComponentList counted = components(kListedBlocks, machine);
  EXPECT_EQ(row(counted, "amplifiers").missing(), 2);
  EXPECT_EQ(row(counted, "multipliers").missing(), 0);
  EXPECT_EQ(counted.verdict(), ComponentList::Verdict::does_not_fit);
  EXPECT_TRUE(counted.absent().empty());
}

TEST(ComponentList, CannotTellWhereACountIsNotPublished) {
  diagram::MachineProfile machine = inverting_machine();
  set_count(machine, diagram::ElementKind::multiplier, std::nullopt);
  EXPECT_EQ(components(kListedBlocks, machine).verdict(), ComponentList::Verdict::cannot_tell);
  EXPECT_EQ(row(components(kListedBlocks, machine), "multipliers").missing(), 0);
  set_count(machine, diagram::ElementKind::amplifier, 4);  // enough to know
  EXPECT_EQ(components(kListedBlocks, machine).verdict(), ComponentList::Verdict::does_not_fit);
}

// What is no gain of an input is a potentiometer, or not; a weight at a multiplier is one for certain.
TEST(ComponentList, CannotTellWhereTheGainsOfInputsAreNotPublished) {
  const std::string blocks =
      "x = { type = \"integrator\", in = [\"0.3*x\"] }\nm = { type = \"multiplier\", in = [\"0.5*x\", \"x\"] "
      "}\n";
  diagram::MachineProfile machine = inverting_machine();
  machine.input_gains.clear();
  EXPECT_EQ(row(components(blocks, machine), "potentiometers").needed, 1);
  EXPECT_EQ(components(blocks, machine).verdict(), ComponentList::Verdict::fits);
  machine.input_gains_known = false;
  EXPECT_TRUE(row(components(blocks, machine), "potentiometers").at_least);
  EXPECT_EQ(components(blocks, machine).verdict(), ComponentList::Verdict::cannot_tell);
}

TEST(ComponentList, NamesKindsThatTheMachineHasNot) {
  diagram::MachineProfile machine = inverting_machine();
  remove(machine, diagram::ElementKind::multiplier);
  const std::string blocks = std::string(kListedBlocks) + "c = { type = \"cosine\", in = \"x\" }\n";
  const ComponentList counted = components(blocks, machine);
  EXPECT_THAT(counted.absent(), ElementsAre("multipliers", "cosine"));
  EXPECT_EQ(counted.verdict(), ComponentList::Verdict::does_not_fit);
}

TEST(ComponentList, MissesTimeFactors) {
  diagram::MachineProfile machine = inverting_machine();
  machine.rates = {1, 500};
  const ComponentList counted = components(
      "x = { type = \"integrator\", in = [\"y\"], rate = 6.3e7 }\ny = { type = \"integrator\", in = [\"x\"] "
      "}\n",
      machine);
  EXPECT_EQ(row(counted, "integrators with k0 = 6.3e+07 1/s").missing(), 1);
  EXPECT_EQ(row(counted, "integrators with k0 = 6.3e+07 1/s").note, "k0 on this machine: 1, 500 1/s");
  EXPECT_TRUE(counted.absent().empty());
}

// x twice with 0.3 shares a potentiometer; −0.3 x takes an inverter and, behind it, one of its own.
TEST(ComponentList, CountsPotentiometersAndInvertersThatWeightsAskFor) {
  const std::string blocks = R"(
one = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["0.3*y", "-one"], initial = 0.5 }
y = { type = "integrator", in = ["0.3*x"] }
z = { type = "integrator", in = ["3*x", "-0.3*x", "10*y"], initial = -1 }
)";
  const ComponentList counted = components(blocks, inverting_machine());
  // the constant, 0.3 y, the initial value 0.5, 0.3 x, −0.3 x
  EXPECT_EQ(row(counted, "potentiometers").needed, 5);
  EXPECT_EQ(row(counted, "amplifiers").note, "1 inverter, 3 integrators");
  // with signs: the constant, 0.3 y, ±0.3 x
  EXPECT_EQ(row(components(blocks, signed_machine()), "potentiometers").needed, 4);
  EXPECT_EQ(row(components(blocks, signed_machine()), "amplifiers").note, "3 integrators");
}

TEST(ComponentList, AsksNothingForNothing) {
  const ComponentList counted = components(
      "zero = { type = \"constant\", value = 0 }\n"
      "x = { type = \"integrator\", in = [\"zero\", \"0*x\"] }\n",
      inverting_machine());
  EXPECT_EQ(counted.rows.size(), 2U);  // an amplifier and its network
}

TEST(ComponentList, TakesAGainForWhatItStandsFor) {
  const ComponentList counted = components(
      "x = { type = \"integrator\", in = [\"g\"] }\ng = { type = \"gain\", in = \"x\", factor = -3 }\n",
      inverting_machine());
  EXPECT_EQ(row(counted, "potentiometers").needed, 1);
  EXPECT_EQ(row(counted, "amplifiers").note, "1 summer, 1 inverter, 1 integrator");
  const ComponentList turned = components(
      "x = { type = \"integrator\", in = [\"g\"] }\ng = { type = \"gain\", in = \"x\", factor = -1 }\n",
      inverting_machine());
  EXPECT_EQ(row(turned, "amplifiers").note, "1 inverter, 1 integrator");
}

TEST(ComponentList, CannotTellWhereTimeFactorsAreNotPublished) {
  diagram::MachineProfile machine = inverting_machine();
  machine.rates.clear();
  machine.rates_known = false;
  const ComponentList fast = components("x = { type = \"integrator\", in = \"x\", rate = 12345 }\n", machine);
  EXPECT_EQ(row(fast, "integrators with k0 = 1.234e+04 1/s").available, std::nullopt);
  EXPECT_FALSE(row(fast, "integrators with k0 = 1.234e+04 1/s").at_least);  // what is needed is counted
  EXPECT_EQ(fast.verdict(), ComponentList::Verdict::cannot_tell);
  EXPECT_EQ(components("x = { type = \"integrator\", in = \"x\" }\n", machine).verdict(),
            ComponentList::Verdict::fits);
}

// 5 samples and the one that goes out; two Zener diodes, one diode, and the amplifiers about two of them.
TEST(ComponentList, CountsWhatBlocksWithoutARoleRequire) {
  diagram::MachineProfile machine = inverting_machine();
  const std::string blocks = R"(
x = { type = "integrator", in = ["a", "l", "s", "d"] }
l = { type = "delay-line", in = "x", stages = 4.5 }
s = { type = "track-and-store", in = "x", track = "l" }
a = { type = "diode-amplifier", in = ["x"], feedback = 0, gain = 1e4 }
r = { type = "diode-amplifier", in = ["a"], low = "-inf", high = 0 }
d = { type = "diode", in = "r" }
)";
  ComponentList counted = components(blocks, machine);
  EXPECT_EQ(row(counted, "stores").needed, 7);
  EXPECT_THAT(row(counted, "stores").blocks, ElementsAre("l", "s"));
  EXPECT_EQ(row(counted, "diodes").needed, 4);
  EXPECT_EQ(row(counted, "amplifiers").needed, 3);
  EXPECT_EQ(row(counted, "amplifiers").note, "1 integrator, 2 open amplifiers");
  // A profile that does not name them does not say by that that there are none.
  EXPECT_TRUE(row(counted, "stores").exists);
  EXPECT_FALSE(row(counted, "stores").available);
  EXPECT_EQ(counted.verdict(), ComponentList::Verdict::cannot_tell);
  set_count(machine, diagram::ElementKind::store, 6);
  set_count(machine, diagram::ElementKind::diode, 4);
  counted = components(blocks, machine);
  EXPECT_EQ(row(counted, "stores").missing(), 1);
  EXPECT_EQ(row(counted, "diodes").missing(), 0);
  EXPECT_EQ(counted.verdict(), ComponentList::Verdict::does_not_fit);
}

// A magnitude is two amplifiers with two diodes, a limiter one with a diode for each of its limits.
TEST(ComponentList, CountsTheDiodesOfMagnitudesAndLimiters) {
  const ComponentList counted = components(R"(
x = { type = "integrator", in = ["m", "l", "k"] }
m = { type = "absolute-value", in = "x" }
l = { type = "limiter", in = "x" }
k = { type = "limiter", in = "x", low = 0, high = "inf" }
)",
                                           inverting_machine());
  EXPECT_EQ(row(counted, "diodes").needed, 5);
  EXPECT_EQ(row(counted, "amplifiers").needed, 5);
  EXPECT_EQ(counted.verdict(), ComponentList::Verdict::cannot_tell);
}

// What a block without a role requires of a kind that has blocks of its own is counted with them.
TEST(ComponentList, CountsWhatIsRequiredWithTheElementsOfItsKind) {
  const diagram::BlockLibrary library =
      testing::shipped_blocks_and("own",
                                  "[requires]\nmultiplier = \"2\"\n[inputs]\nin = {}\n[outputs]\nout = {}\n"
                                  "[equations]\nout = \"in^4\"\n");
  const ComponentList counted = component_list_of(
      diagram::flatten(diagram::parse_diagram(
                           testing::diagram_text("x = { type = \"integrator\", in = \"m\" }\n"
                                                 "o = { type = \"own\", in = \"x\" }\n"
                                                 "m = { type = \"multiplier\", in = [\"o\", \"x\"] }\n"),
                           "d.toml"),
                       library),
      inverting_machine());
  EXPECT_EQ(row(counted, "multipliers").needed, 3);
  EXPECT_THAT(row(counted, "multipliers").blocks, ElementsAre("m", "o"));
}

}  // namespace
}  // namespace oblique::machine
