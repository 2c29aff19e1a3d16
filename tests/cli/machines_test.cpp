// SPDX-License-Identifier: MIT
// `oblique machines`, and what a diagram on a machine prints.
#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "../support/process.h"

namespace oblique::test {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

Outcome oblique(const std::string& arguments) {
  return run_command("oblique " + arguments, OBLIQUE_SOURCE_DIR);
}

/// Characters of the longest line.
std::ptrdiff_t widest_line(const std::string& text) {
  std::ptrdiff_t widest = 0;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    widest = std::max(widest, std::count_if(line.begin(), line.end(), begins_character));
  }
  return widest;
}

TEST(Machines, AreListed) {
  const Outcome outcome = oblique("machines");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, ContainsRegex("tr-10 +EAI PACE TR-10 \\(1959\\) +10 V +20 +18 +– +9 +24\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("mn-14 +МН-14 \\(MN-14\\) +\\? +– +20 +30 +\\? +\\?\n"));
  EXPECT_LE(widest_line(outcome.out), 100);
}

TEST(Machines, AreToldAllAbout) {
  const Outcome outcome = oblique("machines the-analog-thing");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("THE ANALOG THING (the-analog-thing)\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("machine unit +10 V\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("time factors k0 \\[1/s\\] +10, 1000\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("coefficients +0 … 1\n"));
  EXPECT_THAT(oblique("machines lucidac").out, ContainsRegex("coefficients +−1 … 1\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("multiplier +2 +AD633JR\n"));
  EXPECT_THAT(outcome.out,
              ContainsRegex("comparator, hysteresis +about 170 mV +\\[one user's measurement\\]\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("integrator, drift +unknown\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("multiplier +bandwidth +1e\\+06 Hz +multiplier, bandwidth\n"));
  EXPECT_THAT(
      outcome.out,
      ContainsRegex("integrator +capacitor_tolerance +each its own within ± 0.02 +capacitors, tolerance\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\nsource: its public documentation and bill of materials\n"));
}

TEST(Machines, WithoutErrorsActOnNothing) {
  const Outcome outcome = oblique("machines ideal");
  EXPECT_THAT(outcome.out, Not(HasSubstr("acts on")));
  EXPECT_THAT(outcome.out, HasSubstr("do not invert"));
}

TEST(Machines, AreJson) {
  const json all = json::parse(oblique("machines --json").out);
  EXPECT_EQ(all.size(), 21U);
  EXPECT_EQ(all[0]["name"], "ideal");
  EXPECT_EQ(all[0]["elements"][0]["count"], "any");
  const json machine = json::parse(oblique("machines gp-6 --json").out);
  EXPECT_EQ(machine["unit"], 10);
  EXPECT_EQ(machine["rates"], "unknown");
  EXPECT_EQ(machine["elements"][1],
            (json{{"element", "integrator"}, {"count", 4}, {"note", "networks of amplifiers 1–4"}}));
  EXPECT_EQ(machine["elements"][4]["count"], "unknown");
  const json ec1 = json::parse(oblique("machines ec-1 --json").out);
  EXPECT_EQ(ec1["rates"], "any");
  EXPECT_EQ(ec1["errors"][0], (json{{"block", "summer"},
                                    {"parameter", "gain"},
                                    {"value", 1000},
                                    {"figure", "amplifier, open-loop gain"}}));
  EXPECT_EQ(json::parse(oblique("machines mn-7 --json").out)["unit"], "unknown");
}

TEST(Machines, ThatAreUnknownAreRefusedWithTheNearestName) {
  const Outcome outcome = oblique("machines МН-14");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(
      outcome.err,
      "error: there is no machine 'МН-14'\n  remedy: did you mean 'mn-14'? `oblique machines` lists all\n");
}

TEST(Machines, MakeARunTellItsOverloads) {
  const std::string diagram =
      "printf 'format = \"oblique-diagram/1\"\\n[machine]\\nprofile = \"%s\"\\n[blocks]\\n"
      "a = { type = \"constant\", value = 1.5 }\\n' ";
  EXPECT_THAT(run_command(diagram + "tr-10 | oblique run /dev/stdin", OBLIQUE_SOURCE_DIR).err,
              HasSubstr("overload: 'a' leaves ±1 machine unit at t = 0 s, peak 1.5"));
  EXPECT_THAT(run_command(diagram + "ideal | oblique run /dev/stdin", OBLIQUE_SOURCE_DIR).err,
              Not(HasSubstr("overload")));
  const Outcome unknown = run_command(diagram + "tr10 | oblique run /dev/stdin", OBLIQUE_SOURCE_DIR);
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err,
              HasSubstr("/dev/stdin:3:11: there is no machine 'tr10'\n  remedy: did you mean 'tr-10'?"));
}

}  // namespace
}  // namespace oblique::test
