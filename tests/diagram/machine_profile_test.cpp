// SPDX-License-Identifier: MIT
// What the shipped machines say, and how they are found.
#include <oblique/diagram/machine_profile.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/block_library.h>

namespace oblique::diagram {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

class EveryMachine : public ::testing::TestWithParam<std::string> {
 protected:
  const MachineProfile& machine() const { return *find_machine(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Shipped, EveryMachine, ::testing::ValuesIn(machine_names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', 'X');
  return name;
});

TEST_P(EveryMachine, SaysWhereItsFiguresAreFromOrThatTheyAreUnknown) {
  EXPECT_FALSE(machine().title.empty());
  EXPECT_FALSE(machine().source.empty());
  for (const MachineFigure& figure : machine().figures) {
    EXPECT_FALSE(figure.value.empty()) << figure.name;
    EXPECT_EQ(figure.source.empty(), figure.value == "unknown") << figure.name;
  }
}

TEST_P(EveryMachine, SaysOfEachUsualFigureWhatIsKnown) {
  if (GetParam() == "ideal") return;
  for (const char* const usual : {"amplifier, open-loop gain", "amplifier, bandwidth", "amplifier, offset",
                                  "integrator, drift", "resistors, tolerance", "capacitors, tolerance",
                                  "multiplier, static error", "potentiometer, resolution"}) {
    const auto same_name = [&](const MachineFigure& figure) { return figure.name == usual; };
    EXPECT_EQ(std::count_if(machine().figures.begin(), machine().figures.end(), same_name), 1) << usual;
  }
}

TEST_P(EveryMachine, ActsOnParametersOfShippedBlocksWithinTheirRange) {
  const BlockLibrary library = BlockLibrary::shipped();
  const auto parameter_of = [&](const BlockFigure& figure) {
    const BlockDefinition* const block = library.find(figure.block);
    const auto index = block == nullptr ? std::nullopt : block->find_parameter(figure.parameter);
    return index ? &block->parameters[*index] : nullptr;
  };
  for (const BlockFigure& figure : machine().errors) {
    const ParameterDefinition* const parameter = parameter_of(figure);
    ASSERT_NE(parameter, nullptr) << figure.block << '.' << figure.parameter;
    EXPECT_TRUE(parameter->allows(figure.value)) << figure.block << '.' << figure.parameter;
  }
  for (const BlockFigure& figure : machine().scatters) {
    const ParameterDefinition* const parameter = parameter_of(figure);
    ASSERT_NE(parameter, nullptr) << figure.block << '.' << figure.parameter;
    EXPECT_TRUE(parameter->allows(parameter->default_value - figure.value)) << figure.parameter;
  }
}

TEST_P(EveryMachine, ActsByFiguresItNames) {
  const auto is_named = [&](const BlockFigure& acting) {
    return std::any_of(machine().figures.begin(), machine().figures.end(), [&](const MachineFigure& f) {
      return f.name == acting.figure && f.value != "unknown";
    });
  };
  EXPECT_TRUE(std::all_of(machine().errors.begin(), machine().errors.end(), is_named));
  EXPECT_TRUE(std::all_of(machine().scatters.begin(), machine().scatters.end(), is_named));
}

TEST(ShippedMachines, AreTheFilesOfTheDirectory) {
  std::vector<std::string> stems;
  for (const auto& file :
       std::filesystem::directory_iterator(std::filesystem::path(OBLIQUE_SOURCE_DIR) / "src/machines")) {
    if (file.path().extension() == ".toml" && file.path().stem() != "ideal")
      stems.push_back(file.path().stem().string());
  }
  std::sort(stems.begin(), stems.end());
  stems.insert(stems.begin(), "ideal");
  EXPECT_EQ(machine_names(), stems);
}

/// How many a machine has; −1 where that is unknown, 0 for none.
double count_of(const char* machine, ElementKind kind) {
  const ElementCount* const element = find_machine(machine)->find(kind);
  return element == nullptr ? 0 : element->count.value_or(-1);
}

/// The value of an error or a scatter; "not a number" where there is none.
double value_of(const std::vector<BlockFigure>& figures, std::string_view block, std::string_view parameter) {
  for (const BlockFigure& figure : figures) {
    if (figure.block == block && figure.parameter == parameter) return figure.value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

TEST(ShippedMachines, HaveTheElementsThatArePublished) {
  EXPECT_EQ(count_of("ideal", ElementKind::amplifier), kNoLimit);
  EXPECT_EQ(count_of("tr-10", ElementKind::amplifier), 20);
  EXPECT_EQ(count_of("tr-10", ElementKind::integrator), 18);
  EXPECT_EQ(count_of("tr-10", ElementKind::potentiometer), 24);
  EXPECT_EQ(count_of("tr-10", ElementKind::multiplier), 9);
  EXPECT_EQ(count_of("tr-10", ElementKind::comparator), 1);
  EXPECT_EQ(count_of("the-analog-thing", ElementKind::integrator), 5);
  EXPECT_EQ(count_of("the-analog-thing", ElementKind::summer), 4);
  EXPECT_EQ(count_of("the-analog-thing", ElementKind::inverter), 4);
  EXPECT_EQ(count_of("the-analog-thing", ElementKind::multiplier), 2);
  EXPECT_EQ(count_of("the-analog-thing", ElementKind::comparator), 2);
  EXPECT_EQ(count_of("the-analog-thing", ElementKind::potentiometer), 8);
  EXPECT_EQ(count_of("lucidac", ElementKind::integrator), 8);
  EXPECT_EQ(count_of("lucidac", ElementKind::potentiometer), 32);
  EXPECT_EQ(count_of("lucidac", ElementKind::comparator), 0);
  EXPECT_EQ(count_of("model-1", ElementKind::multiplier), kNoLimit);
  EXPECT_EQ(count_of("ec-1", ElementKind::amplifier), 9);
  EXPECT_EQ(count_of("ec-1", ElementKind::potentiometer), 5);
  EXPECT_EQ(count_of("ec-1", ElementKind::multiplier), 0);
  EXPECT_EQ(count_of("rat-700", ElementKind::amplifier), 15);
  EXPECT_EQ(count_of("rat-700", ElementKind::multiplier), -1);
  EXPECT_EQ(count_of("gp-6", ElementKind::integrator), 4);
  EXPECT_EQ(count_of("mn-14", ElementKind::integrator), 20);
  EXPECT_EQ(count_of("mn-14", ElementKind::summer), 30);
  EXPECT_EQ(count_of("avk-31", ElementKind::potentiometer), 34);
  EXPECT_EQ(count_of("mn-7", ElementKind::amplifier), -1);
  EXPECT_EQ(count_of("mpt-9", ElementKind::amplifier), -1);
  EXPECT_EQ(count_of("meda-42", ElementKind::amplifier), 40);
  EXPECT_EQ(count_of("meda-42", ElementKind::integrator), 12);
  EXPECT_EQ(count_of("meda-42", ElementKind::potentiometer), 38);
  EXPECT_EQ(count_of("meda-42", ElementKind::multiplier), 4);
  EXPECT_EQ(count_of("meda-42", ElementKind::function_generator), 3);
  EXPECT_EQ(count_of("dornier-240", ElementKind::amplifier), 49);
  EXPECT_EQ(count_of("tr-20", ElementKind::amplifier), 20);
  EXPECT_EQ(count_of("tr-48", ElementKind::amplifier), 48);
  for (const char* const name : {"eai-380", "eai-580", "eai-680", "meda-43", "ra-770"}) {
    EXPECT_EQ(count_of(name, ElementKind::amplifier), -1) << name;
    EXPECT_EQ(count_of(name, ElementKind::multiplier), -1) << name;
  }
}

TEST(ShippedMachines, HaveTheUnitsAndStepsThatArePublished) {
  EXPECT_EQ(find_machine("tr-10")->unit, 10);
  EXPECT_EQ(find_machine("lucidac")->unit, 2);
  EXPECT_EQ(find_machine("ec-1")->unit, 60);
  EXPECT_EQ(find_machine("mn-7")->unit, std::nullopt);
  EXPECT_THAT(find_machine("the-analog-thing")->rates, ElementsAre(10, 1000));
  EXPECT_THAT(find_machine("lucidac")->rates, ElementsAre(100, 10000));
  EXPECT_THAT(find_machine("model-1")->rates, ElementsAre(1, 10, 100, 1000));
  EXPECT_THAT(find_machine("tr-10")->input_gains, ElementsAre(1, 10));
  EXPECT_THAT(find_machine("eai-580")->rates, ElementsAre(1, 10, 500, 5000));
  EXPECT_EQ(find_machine("dornier-240")->unit, 10);
  EXPECT_EQ(find_machine("tr-48")->unit, std::nullopt);
  EXPECT_TRUE(find_machine("lucidac")->signed_coefficients);
  EXPECT_FALSE(find_machine("tr-10")->signed_coefficients);
  EXPECT_FALSE(find_machine("lucidac")->inverting_summers);  // identity elements
  EXPECT_TRUE(find_machine("tr-10")->inverting_summers);
  EXPECT_FALSE(find_machine("ideal")->inverting);
  EXPECT_TRUE(find_machine("mn-14")->inverting);
  // Unknown is not the same as any.
  EXPECT_THAT(find_machine("mn-14")->rates, IsEmpty());
  EXPECT_FALSE(find_machine("mn-14")->rates_known);
  EXPECT_THAT(find_machine("ec-1")->rates, IsEmpty());
  EXPECT_TRUE(find_machine("ec-1")->rates_known);
}

// Volts over the machine unit, percent over 100, full scale of 20 V over 10 V, by hand.
TEST(ShippedMachines, TurnPublishedFiguresIntoParameters) {
  const MachineProfile& tr10 = *find_machine("tr-10");
  EXPECT_DOUBLE_EQ(value_of(tr10.errors, "summer", "offset"), 2e-6);
  EXPECT_DOUBLE_EQ(value_of(tr10.errors, "servo-amplifier", "offset"), 2e-6);
  EXPECT_DOUBLE_EQ(value_of(tr10.errors, "integrator", "drift"), 5e-6);
  EXPECT_DOUBLE_EQ(value_of(tr10.errors, "inverter", "bandwidth"), 2e5);
  EXPECT_DOUBLE_EQ(value_of(tr10.errors, "multiplier", "error"), 8e-3);
  EXPECT_DOUBLE_EQ(value_of(tr10.errors, "potentiometer", "turns"), 4000);
  EXPECT_DOUBLE_EQ(value_of(tr10.scatters, "integrator", "capacitor_tolerance"), 1e-3);
  EXPECT_DOUBLE_EQ(value_of(tr10.scatters, "integrator", "tolerance"), 1e-3);
  EXPECT_DOUBLE_EQ(value_of(tr10.scatters, "summer", "tolerance"), 2e-3);
  for (const char* const block : {"summer", "inverter", "integrator", "servo-amplifier"})
    EXPECT_EQ(value_of(find_machine("ec-1")->errors, block, "gain"), 1000) << block;
  const MachineProfile& thing = *find_machine("the-analog-thing");
  EXPECT_DOUBLE_EQ(value_of(thing.errors, "multiplier", "error"), 0.02);
  EXPECT_DOUBLE_EQ(value_of(thing.errors, "integrator", "offset"), 1e-4);
  EXPECT_DOUBLE_EQ(value_of(thing.scatters, "integrator", "capacitor_tolerance"), 0.02);
  // Those that are turned by hand have no steps; those of its hybrid controller have 10 bits.
  EXPECT_TRUE(std::isnan(value_of(find_machine("model-1")->errors, "potentiometer", "turns")));
  EXPECT_EQ(value_of(find_machine("model-1")->errors, "digital-potentiometer", "bits"), 10);
  EXPECT_EQ(value_of(find_machine("lucidac")->errors, "potentiometer", "turns"), 2047);
  EXPECT_THAT(find_machine("ideal")->errors, IsEmpty());
  EXPECT_THAT(find_machine("ideal")->scatters, IsEmpty());
}

TEST(FindMachine, KnowsExactNamesOnly) {
  EXPECT_EQ(find_machine("tr-10")->name, "tr-10");
  EXPECT_EQ(find_machine("TR-10"), nullptr);
  EXPECT_EQ(find_machine(""), nullptr);
}

TEST(UnknownMachine, NamesTheNearestOne) {
  const auto remedy = [](std::string_view name) { return unknown_machine(name).remedy.words(); };
  EXPECT_EQ(unknown_machine("tr10").what, "there is no machine 'tr10'");
  for (const char* const name : {"tr10", "TR-10", "Tr_10"})
    EXPECT_EQ(remedy(name), "did you mean 'tr-10'? 'machines' lists all") << name;
  EXPECT_THAT(remedy("МН-14"), HasSubstr("'mn-14'"));
  EXPECT_THAT(remedy("мн-14"), HasSubstr("'mn-14'"));
  EXPECT_THAT(remedy("МН-7"), HasSubstr("'mn-7'"));
  EXPECT_THAT(remedy("мн-7"), HasSubstr("'mn-7'"));
  EXPECT_THAT(remedy("МПТ-9"), HasSubstr("'mpt-9'"));
  EXPECT_THAT(remedy("Heathkit"), HasSubstr("'ec-1'"));
  EXPECT_THAT(remedy("telefunken"), HasSubstr("'ra-770'"));
  EXPECT_EQ(remedy("abacus"), "'machines' lists those there are");
}

TEST(UnknownMachine, KeepsThePlace) {
  EXPECT_EQ(unknown_machine("abacus", {"d.toml", {3, 11}}).place, (text::Place{"d.toml", {3, 11}}));
}

TEST(ElementName, IsAWordForPeople) {
  EXPECT_EQ(element_name(ElementKind::potentiometer), "potentiometer");
  EXPECT_EQ(element_name(ElementKind::function_generator), "function generator");
}

}  // namespace
}  // namespace oblique::diagram
