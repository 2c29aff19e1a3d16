// SPDX-License-Identifier: MIT
// What `compare` prints and writes.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "verbs.h"

namespace oblique::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

using CompareVerb = Verbs;

TEST_F(CompareVerb, GivesTheJsonOfTheContract) {
  const Outcome outcome =
      oblique("compare diagrams/mechanisms/four-bar.toml --gain 1e3,1e4 --json -o " + file("c.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("mechanism"), "Four-bar linkage with a coupler point");
  EXPECT_EQ(json.at("method"), "triangles");
  EXPECT_EQ(json.at("size"), 3.5);
  EXPECT_NEAR(json.at("order").get<double>(), -1, 0.05);
  ASSERT_EQ(json.at("runs").size(), 2U);
  for (const auto& run : json.at("runs")) {
    for (const char* key : {"gain", "max_error", "rms_error", "steps", "seconds", "overloads", "stable"}) {
      EXPECT_TRUE(run.contains(key)) << key;
    }
    EXPECT_EQ(run.at("stable"), true);
  }
  std::ifstream stream(file("c.json"));
  EXPECT_EQ(nlohmann::json::parse(stream).at("size"), 3.5);
}

TEST_F(CompareVerb, RunsWhatIsAskedForTwiceOnce) {
  const std::string command = "compare diagrams/mechanisms/four-bar.toml --json ";
  const auto twice =
      nlohmann::json::parse(oblique(command + "--gain 1e3,1e4,1000 --method triangles,triangles").out);
  EXPECT_EQ(twice["runs"].size(), 2U);
  EXPECT_EQ(twice["series"].size(), 1U);
}

TEST_F(CompareVerb, LeavesOutAMethodThatDoesNotFit) {
  const std::string command = "compare diagrams/mechanisms/four-bar.toml --gain 1e3 --method paper,triangles";
  const Outcome table = oblique(command);
  EXPECT_EQ(table.status, 0);
  EXPECT_THAT(table.err,
              ::testing::StartsWith(
                  "warning: method paper is left out: diagrams/mechanisms/four-bar.toml:23:1: the group "
                  "BCM-CD (RRR) is of a kind that the source does not have"));
  EXPECT_THAT(table.out, HasSubstr("servo-tracked triangles"));
  const auto json = nlohmann::json::parse(oblique(command + " --json").out);
  EXPECT_EQ(json.at("runs").size(), 1U);
  EXPECT_EQ(json.at("refused").at(0).at("method"), "paper");
  EXPECT_TRUE(json.at("refused").at(0).at("gain").is_null());
}

TEST_F(CompareVerb, TakesTheSplitThatARefusalNames) {
  const std::string command = "compare diagrams/mechanisms/stephenson-ii.toml --method paper --gain 1e3";
  const Outcome refused = oblique(command);
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err, ::testing::EndsWith("remedy: --split HG,BC,EF never flips\n"));
  EXPECT_EQ(oblique(command + " --split HG,BC,EF").status, 0);
  const Outcome patched = oblique("patch diagrams/mechanisms/stephenson-ii.toml --method paper");
  EXPECT_THAT(
      patched.err,
      ::testing::EndsWith("remedy: --split HG,BC,EF never flips; --force writes this one all the same\n"));
}

TEST_F(CompareVerb, HoldsMethodsAndBandwidthsAgainstEachOther) {
  const std::string command =
      "compare diagrams/mechanisms/six-bar.toml --method triangles,gradient --bandwidth 2000,20kHz --gain "
      "1e3,1e4";
  const Outcome table = oblique(command);
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("   method     Hz   gain  max error [mm]"));
  EXPECT_THAT(table.out, ::testing::Not(HasSubstr("wrong branch")));
  EXPECT_THAT(
      table.out,
      HasSubstr("worst at C, 180°: the triangle B–C–D is nearest to collinear there (sin γ = 0.27 at B)"));
  EXPECT_THAT(table.out, HasSubstr("   method     Hz  power of the gain  left at gain 1e12 [mm]"));
  const Outcome outcome = oblique(command + " --json");
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("method"), "triangles,gradient");
  EXPECT_TRUE(json.at("order").is_null());  // of which?
  ASSERT_EQ(json.at("runs").size(), 8U);
  EXPECT_EQ(json.at("runs")[7].at("method"), "gradient");
  EXPECT_EQ(json.at("runs")[7].at("bandwidth"), 20000);
  EXPECT_EQ(json.at("runs")[0].at("worst").at("point"), "C");
  double sum = 0;
  for (const char* part : {"static", "lag", "solver"})
    sum += json.at("runs")[0].at("parts").at(part).get<double>();
  EXPECT_NEAR(sum, json.at("runs")[0].at("max_error").get<double>(), 1e-12);  // an identity, but for rounding
  ASSERT_EQ(json.at("series").size(), 4U);
  EXPECT_NEAR(json.at("series")[3].at("order").get<double>(), -1, 0.05);
}

TEST_F(CompareVerb, JsonHoldsSecondsWhereTheyAreAskedFor) {
  const std::string command =
      "compare diagrams/mechanisms/four-bar.toml --gain 1e3 --tolerance 1% --monte-carlo 3 ";
  const auto plain = nlohmann::json::parse(oblique(command + "--json").out);
  EXPECT_TRUE(plain.at("runs")[0].at("seconds").is_null());
  EXPECT_TRUE(plain.at("monte_carlo").at("seconds").is_null());
  const auto timed = nlohmann::json::parse(oblique(command + "--json --timings").out);
  EXPECT_GT(timed.at("runs")[0].at("seconds").get<double>(), 0);
  EXPECT_GT(timed.at("monte_carlo").at("seconds").get<double>(), 0);
  const Outcome refused = oblique(command + "--timings");
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.err,
            "error: --timings adds to the JSON, and none is written; expected --json or -o FILE.json beside "
            "it\n");
}

TEST_F(CompareVerb, MonteCarloGivesTheSameForAnyNumberOfThreadsAndRepeatsItsWorstRun) {
  const std::string command = "compare diagrams/mechanisms/four-bar.toml --tolerance 0.1% --seed 7 --json ";
  const auto drawn = [&](const std::string& rest) {
    const Outcome outcome = oblique(command + rest);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out).at("monte_carlo");
  };
  const auto one = drawn("--monte-carlo 20 --threads 1");
  EXPECT_EQ(one, drawn("--monte-carlo 20 --threads 3"));
  EXPECT_EQ(one.at("errors").size(), 20U);
  EXPECT_TRUE(one.at("failures").empty());
  const auto worst = one.at("worst_run").get<int>();
  EXPECT_EQ(one.at("errors")[static_cast<std::size_t>(worst)], one.at("percentiles").at("100"));
  const auto again = drawn("--monte-carlo 1 --first-run " + std::to_string(worst));
  EXPECT_EQ(again.at("errors")[0], one.at("percentiles").at("100"));
  EXPECT_LE(std::abs(again.at("draws").at("C.cx.tolerance").get<double>()), 1e-3);
}

TEST_F(CompareVerb, TellsTheYieldOfTheMachinesThatItDraws) {
  const std::string command =
      "compare diagrams/mechanisms/four-bar.toml --gain 1e4 --tolerance 0.5% --monte-carlo 300 --yield 1%";
  EXPECT_THAT(oblique(command).out,
              HasSubstr(" of 300 machines err by less than 0.035 m (1 % of the largest link): "));
  const auto drawn =
      nlohmann::json::parse(oblique(command + " --until-within 10% --json").out).at("monte_carlo");
  const auto& yield = drawn.at("yield");
  EXPECT_EQ(yield.at("machines"), 100);  // 1.96·½/√100 is within 10 % whatever the yield
  EXPECT_EQ(drawn.at("errors").size(), 100U);
  int good = 0;
  for (const auto& error : drawn.at("errors")) good += error.get<double>() < 0.035 ? 1 : 0;
  EXPECT_EQ(yield.at("good"), good);
  EXPECT_LT(yield.at("low").get<double>(), yield.at("part").get<double>());
}

TEST_F(CompareVerb, OnAMachineGivesTheBudgetAndItsScatter) {
  const std::string command =
      "compare diagrams/mechanisms/four-bar.toml --machine tr-10 --gain 1e3 --monte-carlo 5";
  const Outcome text = oblique(command);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("on EAI PACE TR-10 (1959), of as many elements as it takes"));
  EXPECT_THAT(text.out, HasSubstr("the method and each figure alone add up to 100.0 % of it"));
  EXPECT_THAT(text.out, HasSubstr("uniform as those of EAI PACE TR-10 (1959) scatter"));
  const auto json = nlohmann::json::parse(oblique(command + " --json").out);
  EXPECT_NEAR(json.at("machine").at("explained").get<double>(), 1, 0.02);
  EXPECT_EQ(json.at("machine").at("figures").back().at("figure"), "potentiometer, resolution");
  EXPECT_EQ(json.at("monte_carlo").at("errors").size(), 5U);
  // about the machine's own error, by 0.2 % and less of each element
  const double machine = json.at("machine").at("max_error");
  EXPECT_NEAR(json.at("monte_carlo").at("percentiles").at("50").get<double>(), machine, 0.15 * machine);
}

TEST_F(CompareVerb, MonteCarloTellsWhatFailed) {
  const Outcome outcome =
      oblique("compare diagrams/mechanisms/four-bar.toml --monte-carlo 12 --tolerance 50% --threads 1");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              ::testing::ContainsRegex("FAILED [0-9]+ of 12 runs, left out above; the first, run "));
}

TEST_F(CompareVerb, SaysWhoseToleranceAnErrorIs) {
  const Outcome outcome =
      oblique("compare diagrams/mechanisms/four-bar.toml --budget --tolerance 0.1% -o " + file("b.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("Error budget: 30 tolerances, uniform within ±0.1%; together they displace "
                        "point C by "));
  EXPECT_THAT(outcome.out, HasSubstr("(10 others together 0.1 %)"));
  std::ifstream stream(file("b.json"));
  const auto budget = nlohmann::json::parse(stream).at("budget");
  ASSERT_EQ(budget.at("elements").size(), 30U);
  EXPECT_EQ(budget.at("point"), "C");
  double shares = 0;
  for (const auto& element : budget.at("elements")) shares += element.at("share").get<double>();
  EXPECT_NEAR(shares, 1, 1e-12);
  EXPECT_GE(budget.at("elements").at(0).at("share"), budget.at("elements").at(1).at("share"));
}

TEST_F(CompareVerb, TellsOfTheScatterThatABudgetNeeds) {
  const std::string four_bar = "compare diagrams/mechanisms/four-bar.toml ";
  const Outcome without = oblique(four_bar + "--budget");
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err,
              HasSubstr("--budget without how far the elements scatter; expected --tolerance, such as "
                        "0.1%, or a --machine"));
  const Outcome alone = oblique(four_bar + "--tolerance 1%");
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err, HasSubstr("--tolerance says how elements scatter, and nothing asks for it; expected "
                                   "--budget or --monte-carlo N"));
}

}  // namespace
}  // namespace oblique::test
