// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/plan_file.h>

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::ensemble {
namespace {

using ::testing::HasSubstr;

constexpr const char* kWhole = R"toml(format = "oblique-ensemble/1"
title = "Gains and lengths"
version = "0.1.0"
mechanism = "leg.toml"
runs = 1000
seed = 7
sampling = "latin-hypercube"
samples = 361
tolerance = 1e-9
gain = 1e5
method = "gradient"

[vary]
"AB.length" = "0.8..1.2:9"
gain = [1e3, "1e4", 1e5]
"c.in[2]" = 3

[scatter]
tolerance = "0.1%"
machine = "tr-10"
"servo-amplifier.gain" = "20%"

[measure]
worst = "error()"
last = "end(B.x)"
)toml";

std::string finding_of(const std::string& text) {
  try {
    parse_plan(text, "p.toml");
  } catch (const text::Error& error) {
    return error.what();
  }
  return "none";
}

/// Of a plan that is good without the lines.
std::string finding_with(const std::string& lines,
                         const std::string& measure = "\n[measure]\nx = \"end(x)\"\n") {
  return finding_of("format = \"oblique-ensemble/1\"\n" + lines + measure);
}

TEST(PlanFile, HoldsAllThatDefinesAnEnsemble) {
  const PlanFile file = parse_plan(kWhole, "plans/p.toml");
  EXPECT_EQ(file.title, "Gains and lengths");
  EXPECT_EQ(file.version, "0.1.0");
  const Plan& plan = file.plan;
  EXPECT_EQ(plan.file, "plans/p.toml");
  EXPECT_EQ(plan.subject, "plans/leg.toml");
  EXPECT_TRUE(plan.mechanism);
  EXPECT_EQ(plan.runs, 1000U);
  EXPECT_EQ(plan.seed, 7U);
  EXPECT_EQ(plan.sampling, Sampling::latin_hypercube);
  EXPECT_EQ(plan.samples, 361);
  EXPECT_EQ(plan.tolerance, 1e-9);
  EXPECT_EQ(plan.gain, 1e5);
  EXPECT_EQ(plan.method, "gradient");
  ASSERT_EQ(plan.vary.size(), 3U);
  EXPECT_EQ(plan.vary[0].name, "AB.length");
  EXPECT_EQ(plan.vary[0].values, "0.8..1.2:9");
  EXPECT_EQ(plan.vary[0].place, (text::Place{"plans/p.toml", {14, 15}}));
  EXPECT_EQ(plan.vary[1].values, "1000,1e4,100000");
  EXPECT_EQ(plan.vary[2].values, "3");
  EXPECT_EQ(plan.tolerance_of_elements, 0.001);
  EXPECT_EQ(plan.machine, "tr-10");
  ASSERT_EQ(plan.scatter.size(), 1U);
  EXPECT_EQ(plan.scatter[0].block, "servo-amplifier");
  EXPECT_EQ(plan.scatter[0].parameter, "gain");
  EXPECT_EQ(plan.scatter[0].half_width, 0.2);
  EXPECT_TRUE(plan.scatter[0].in_percent);
  ASSERT_EQ(plan.measures.size(), 2U);
  EXPECT_EQ(plan.measures[0].name, "worst");
  EXPECT_EQ(plan.measures[1].expression, "end(B.x)");
}

TEST(PlanFile, IsWrittenInOneWay) {
  const std::string written = write_plan(parse_plan(kWhole, "plans/p.toml"), "plans/q.toml");
  EXPECT_THAT(written, HasSubstr("mechanism = \"leg.toml\"\n"));
  EXPECT_EQ(write_plan(parse_plan(written, "plans/q.toml"), "plans/q.toml"), written);
  // From another folder the path is another one.
  EXPECT_THAT(write_plan(parse_plan(written, "plans/q.toml"), "q.toml"), HasSubstr("\"plans/leg.toml\""));
  EXPECT_THAT(write_plan(parse_plan(written, "plans/q.toml"), "other/q.toml"),
              HasSubstr("\"../plans/leg.toml\""));
  EXPECT_THAT(write_plan(parse_plan(written, "/plans/q.toml"), "other/q.toml"),
              HasSubstr("\"/plans/leg.toml\""));
}

TEST(PlanFile, KeepsSeedsOf64Bits) {
  Plan plan;
  plan.subject = "x.toml";
  plan.measures = {{"x", "end(x)", {}}};
  plan.vary = {{"x.initial", "1,2", {}}};
  for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1} << 53U, (std::uint64_t{1} << 53U) + 1,
                                   std::numeric_limits<std::uint64_t>::max()}) {
    plan.seed = seed;
    EXPECT_EQ(parse_plan(write_plan({{}, {}, plan}, ""), "").plan.seed, seed);
  }
  // A number of TOML beyond that would be another one.
  EXPECT_THAT(
      finding_with("diagram = \"x\"\nseed = 9007199254740993\n[vary]\na = 1\n"),
      HasSubstr(
          "p.toml:3:8: 'seed' of the plan is no whole number that can be told from its neighbours; "
          "expected a whole number from 0 to 9007199254740991, or up to 18446744073709551615 as a text"));
  for (const char* seed : {"-1", "1.5", "\"\"", "\"1x\"", "\"18446744073709551616\"", "true"})
    EXPECT_THAT(finding_with("diagram = \"x\"\nseed = " + std::string(seed) + "\n[vary]\na = 1\n"),
                HasSubstr("p.toml:3:8: 'seed' of the plan is no whole number"));
}

TEST(PlanFile, OfAnotherKindIsToldOf) {
  EXPECT_EQ(finding_of("format = \"oblique-diagram/1\"\n"),
            "p.toml:1:10: the format is 'oblique-diagram/1'; expected 'oblique-ensemble/1'\n"
            "  remedy: this is a diagram: 'run', 'check' and 'draw' take it");
  EXPECT_THAT(finding_of("format = \"oblique-ensemble/2\"\n"),
              HasSubstr("p.toml:1:10: the format is 'oblique-ensemble/2'; expected 'oblique-ensemble/1'"));
}

TEST(PlanFile, ReportsAllFindingsAtTheirPlaces) {
  EXPECT_EQ(finding_of(R"(format = "oblique-ensemble/1"
diagram = "x.toml"
run = 10
sampling = "sobel"
tolerance = 2
[vary]
c.gain = 1
)"),
            "p.toml:3:1: unknown key 'run' in the plan\n"
            "  remedy: did you mean 'runs'?\n"
            "p.toml:4:12: there is no sampling 'sobel'\n"
            "  remedy: did you mean 'sobol'?\n"
            "p.toml:5:13: 'tolerance' of the plan is 2; expected a number above 0 and below 1, such as 1e-8\n"
            "  remedy: that of the elements is 'tolerance' in [scatter]\n"
            "p.toml:7:1: 'c' in [vary] is a table, which gives no values; expected a list of numbers, "
            "\"FROM..TO:STEPS\" or \"FROM..TO:STEPS:log\"\n"
            "  remedy: put the name in quotes: \"c.gain\" = …");
}

TEST(PlanFile, SaysWhatIsMissing) {
  EXPECT_THAT(
      finding_with("[vary]\na = 1\n"),
      HasSubstr("p.toml:1:1: the plan says not what is run; expected diagram = \"FILE.toml\" or mechanism = "
                "\"FILE.toml\""));
  EXPECT_THAT(finding_with("diagram = \"x\"\nmechanism = \"y\"\n[vary]\na = 1\n"),
              HasSubstr("p.toml:3:13: the plan names a diagram and a mechanism; expected one of the two"));
  EXPECT_THAT(finding_with("diagram = \"x\"\n"),
              HasSubstr("p.toml:1:1: nothing varies in this plan: it has neither [vary] nor [scatter]"));
  EXPECT_THAT(finding_with("diagram = \"x\"\n[vary]\n"), HasSubstr("p.toml:3:1: [vary] names nothing"));
  EXPECT_THAT(finding_with("diagram = \"x\"\n[scatter]\n"), HasSubstr("p.toml:3:1: [scatter] names nothing"));
  EXPECT_THAT(finding_with("diagram = \"x\"\n[vary]\na = 1\n", "[measure]\n"),
              HasSubstr("p.toml:5:1: [measure] names nothing"));
  EXPECT_EQ(finding_with("diagram = \"x\"\n[vary]\na = 1\n", ""), "none");
  EXPECT_THAT(finding_with("diagram = \"\"\n[vary]\na = 1\n"),
              HasSubstr("p.toml:2:11: 'diagram' of the plan names no file"));
}

TEST(PlanFile, SaysWhatIsWrong) {
  const std::string vary = "\n[vary]\na = 1\n";
  EXPECT_THAT(
      finding_with("diagram = \"x\"\nruns = 0" + vary),
      HasSubstr("p.toml:3:8: 'runs' of the plan is 0; expected a whole number from 1 to 9007199254740991"));
  EXPECT_THAT(finding_with("diagram = \"x\"\nruns = \"many\"" + vary),
              HasSubstr("p.toml:3:9: 'runs' of the plan"));
  EXPECT_THAT(finding_with("diagram = \"x\"\nsamples = 1.5" + vary),
              HasSubstr("p.toml:3:11: 'samples' of the plan is 1.5"));
  EXPECT_THAT(
      finding_with("diagram = \"x\"\ngain = 1e4" + vary),
      HasSubstr("p.toml:3:8: 'gain' is for mechanisms, which are patched, and this plan has a diagram"));
  EXPECT_THAT(finding_with("mechanism = \"x\"\ngain = -1" + vary),
              HasSubstr("p.toml:3:8: 'gain' of the plan is -1; expected a finite number above 0"));
  EXPECT_THAT(finding_with("diagram = \"x\"\n[vary]\na = []\n"),
              HasSubstr("p.toml:4:5: 'a' in [vary] is an array, which"));
  EXPECT_THAT(finding_with("diagram = \"x\"\n[vary]\na = [1, true]\n"),
              HasSubstr("p.toml:4:5: 'a' in [vary] is an array"));
  EXPECT_THAT(
      finding_with("diagram = \"x\"\n[scatter]\ntolerence = 0.1\n"),
      HasSubstr("p.toml:4:1: 'tolerence' in [scatter] names no parameter of a type of blocks; expected "
                "\"TYPE.PARAMETER\", such as \"multiplier.error\", or tolerance, or machine\n"
                "  remedy: did you mean 'tolerance'?"));
  EXPECT_THAT(
      finding_with("diagram = \"x\"\n[scatter]\ntolerance = 0.6\n"),
      HasSubstr("p.toml:4:13: 'tolerance' of [scatter] is 0.6; expected a number above 0 and up to 50%"));
  EXPECT_THAT(finding_with("diagram = \"x\"\n[scatter]\nmultiplier.error = 0.1\n"),
              HasSubstr("remedy: put the name in quotes: \"multiplier.error\" = …"));
  EXPECT_THAT(
      finding_with("diagram = \"x\"\n[scatter]\n\"multiplier.error\" = 0\n"),
      HasSubstr("p.toml:4:22: 'multiplier.error' in [scatter] is 0; expected half the width of the scatter"));
  EXPECT_THAT(finding_with("diagram = \"x\"" + vary, "[measure]\nworst = 3\n"),
              HasSubstr("'worst' in [measure] is a number; expected an expression over the run in quotes"));
  EXPECT_THAT(finding_of("format = \"oblique-ensemble/1\"\ndiagram = \n"), HasSubstr("p.toml:2:"));
}

}  // namespace
}  // namespace oblique::ensemble
