// SPDX-License-Identifier: MIT
#include <oblique/diagram/role.h>

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/block_library.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

/// What is said of a block with this role, its line the third.
std::string role_message(const std::string& role, const std::string& body) {
  return message_of([&] {
    parse_block("format = \"oblique-block/1\"\ntitle = \"T\"\nrole = \"" + role + "\"\n" + body, "b.toml",
                "b");
  });
}

/// A block of one input, which adds or not, and one output with this equation.
std::string one(const std::string& equation, bool sum, const std::string& parameters = "") {
  return std::string("[inputs]\nx = { sum = ") + (sum ? "true" : "false") +
         " }\n[outputs]\ny = {}\n[parameters]\n" + parameters + equation;
}

constexpr const char* kRemedy =
    "\n  remedy: without a role the block is an element of its own, which a machine may not have";

TEST(Role, OfTheShippedBlocks) {
  const BlockLibrary library = BlockLibrary::shipped();
  std::map<std::string, std::string> roles;
  for (const std::string& name : library.names()) {
    const BlockDefinition& block = *library.find(name);
    if (block.role == Role::other) continue;
    roles[name] = role_name(block.role);
    EXPECT_EQ(library.find(block.role), &block) << "a role is that of one shipped block: figures of machines "
                                                   "name the block and mean the role";
  }
  const std::map<std::string, std::string> expected{{"constant", "reference"},
                                                    {"potentiometer", "potentiometer"},
                                                    {"gain", "gain"},
                                                    {"inverter", "inverter"},
                                                    {"summer", "summer"},
                                                    {"integrator", "integrator"},
                                                    {"servo-amplifier", "open-amplifier"},
                                                    {"multiplier", "multiplier"},
                                                    {"squarer", "squarer"},
                                                    {"comparator", "comparator"},
                                                    {"function-generator", "function-generator"}};
  EXPECT_EQ(roles, expected);
}

TEST(Role, BelongsToTheShippedBlockBeforeAUsers) {
  const std::string summer = "role = \"summer\"\n" + one("[equations]\ny = \"polarity*x\"\n", true);
  const auto block = [&](const std::string& name, const std::string& text) {
    return parse_block("format = \"oblique-block/1\"\ntitle = \"T\"\n" + text, name + ".toml", name);
  };
  BlockLibrary library = BlockLibrary::shipped();
  library.add(block("adder", summer));  // before 'summer' in the alphabet
  EXPECT_EQ(library.find(Role::summer)->name, "summer");
  library.add(block("summer", one("[equations]\ny = \"x\"\n", true)));  // in its place, without the role
  EXPECT_EQ(library.find(Role::summer)->name, "adder");
  EXPECT_EQ(BlockLibrary().find(Role::summer), nullptr);
}

TEST(Role, IsOneThatThereIs) {
  EXPECT_EQ(role_message("sumer", one("[equations]\ny = \"x\"\n", true)),
            "b.toml:3:8: there is no role 'sumer'\n  remedy: did you mean 'summer'?");
  EXPECT_THAT(role_message("other", one("[equations]\ny = \"x\"\n", true)),
              HasSubstr("b.toml:3:8: there is no role 'other'\n  remedy: known: reference, potentiometer, "));
}

TEST(Role, NeedsItsPortsAndParameters) {
  EXPECT_EQ(role_message("multiplier", one("[equations]\ny = \"x*x\"\n", false)),
            std::string("b.toml:3:8: role 'multiplier': the block has 1 input; expected 2 inputs") + kRemedy);
  EXPECT_EQ(role_message("summer", one("[equations]\ny = \"polarity*x\"\n", false)),
            std::string("b.toml:3:8: role 'summer': the first input does not add; expected an input with sum "
                        "= true") +
                kRemedy);
  EXPECT_EQ(
      role_message("integrator", one("[equations]\n\"der(y)\" = \"polarity*x\"\n", true, "initial = {}\n")),
      std::string("b.toml:3:8: role 'integrator': the block has no number 'rate' in [parameters]; "
                  "expected rate and initial") +
          kRemedy);
  EXPECT_EQ(role_message("inverter",
                         "[inputs]\nx = {}\n[outputs]\ny = {}\nz = {}\n[equations]\n"
                         "y = \"-x\"\nz = \"-x\"\n"),
            std::string("b.toml:3:8: role 'inverter': the block has 2 outputs; expected 1 output") + kRemedy);
  EXPECT_THAT(role_message("summer",
                           "[inputs]\nx = { sum = true }\n[outputs]\ny = { wire = \"a\" }\n"
                           "[blocks]\na = { type = \"t\", in = \"x\" }\n"),
              HasSubstr("b.toml:3:8: role 'summer': the block is made of [blocks]; expected a role of each "
                        "of those: a machine sees them alone"));
}

/// Equations that are not those of the role would be another circuit on the machine, without a word.
struct Formula {
  std::string role;
  bool sum;
  std::string parameters;
  std::string right, wrong;  ///< tables of equations
  std::string formula;
};

class RoleFormula : public ::testing::TestWithParam<Formula> {};

TEST_P(RoleFormula, IsHeldAgainstTheEquations) {
  const Formula& f = GetParam();
  EXPECT_EQ(role_message(f.role, one(f.right, f.sum, f.parameters)), "");
  EXPECT_EQ(role_message(f.role, one(f.wrong, f.sum, f.parameters)),
            "b.toml:3:8: role '" + f.role +
                "': with the defaults of the other parameters the equations say something else; expected " +
                f.formula + kRemedy);
}

INSTANTIATE_TEST_SUITE_P(
    Roles, RoleFormula,
    ::testing::Values(
        Formula{"summer", true, "e = {}\n", "[let]\ns = \"polarity*x\"\n[equations]\ny = \"(1 + e)*s + e\"\n",
                "[equations]\ny = \"x\"\n", "out = polarity*in"},
        Formula{"inverter", false, "", "[equations]\ninner = \"x\"\ny = \"-inner\"\n",
                "[equations]\ny = \"-polarity*x\"\n", "out = -in"},
        Formula{"gain", false, "factor = { default = 1 }\n", "[equations]\ny = \"x*factor\"\n",
                "[equations]\ny = \"x/factor\"\n", "out = factor*in"},
        Formula{"potentiometer", false, "setting = { default = 1 }\n", "[equations]\ny = \"setting*x\"\n",
                "[equations]\ny = \"setting^2*x\"\n", "out = setting*in"},
        Formula{"squarer", false, "", "[equations]\ny = \"x^2\"\n", "[equations]\ny = \"abs(x)\"\n",
                "out = in*in"},
        Formula{"integrator", true, "rate = { default = 1 }\ninitial = {}\n",
                "[equations]\n\"der(y)\" = \"in_operate*polarity*rate*x\"\n",
                "[equations]\n\"der(y)\" = \"polarity*rate*x - y/10 - 1/10\"\n",
                "der(out) = polarity*rate*in"},
        Formula{"open-amplifier", true, "gain = { default = inf }\nbandwidth = { default = 10 }\n",
                "[implicit]\ny = \"x + y/gain\"\n", "[implicit]\ny = \"x - y/gain\"\n",
                "at rest out = -gain*in"},
        Formula{"open-amplifier", true, "gain = { default = 1e6 }\nbandwidth = { default = 10 }\n",
                "[equations]\n\"der(y)\" = \"bandwidth*(-y - gain*x)\"\n", "[equations]\ny = \"-gain*x\"\n",
                "at rest out = -gain*in"},
        // without a value by itself: what it names goes round in a circle
        Formula{"inverter", false, "", "[equations]\ny = \"-x\"\n",
                "[equations]\na = \"b\"\nb = \"a\"\ny = \"a\"\n", "out = -in"}));

TEST(Role, OfAReferenceAndAMultiplierIsHeldToo) {
  const std::string reference = "[outputs]\ny = {}\n[parameters]\nvalue = { default = 1 }\n[equations]\n";
  EXPECT_EQ(role_message("reference", reference + "y = \"value\"\n"), "");
  EXPECT_THAT(role_message("reference", reference + "y = 1\n"), HasSubstr("expected out = value"));
  const std::string product = "[inputs]\na = {}\nb = {}\n[outputs]\ny = {}\n[equations]\n";
  EXPECT_EQ(role_message("multiplier", product + "y = \"b*a\"\n"), "");
  EXPECT_THAT(role_message("multiplier", product + "y = \"b*a/10\"\n"), HasSubstr("expected out = x*y"));
}

}  // namespace
}  // namespace oblique::diagram
