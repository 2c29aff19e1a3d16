// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/study.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <oblique/ensemble/study/family.h>

#include "../support/compiled.h"

namespace oblique::ensemble {
namespace {

constexpr const char* kStudiedDecay = R"toml(format = "oblique-diagram/1"
[run]
until = 2
[blocks]
x = { type = "integrator", in = ["-1*x"], initial = 1 }
y = { type = "multiplier", in = ["x", "x"] }
[outputs]
height = { signal = "x", scale = 10, unit = "m" }
)toml";

constexpr const char* kSpring = R"toml(format = "oblique-diagram/1"
[run]
until = 3
[blocks]
v = { type = "integrator", in = ["-4*x"], initial = 0 }
x = { type = "integrator", in = ["v"], initial = 0.5 }
)toml";

Plan plan_of(std::vector<Variation> vary, std::vector<std::string> measures) {
  Plan plan;
  plan.subject = "d.toml";
  plan.vary = std::move(vary);
  for (std::string& measure : measures) plan.measures.push_back({"", std::move(measure), {}});
  return plan;
}

Study study_of(const Plan& plan, const std::string& text) {
  return Study(plan, text, testing::shipped_blocks(), 2);
}

std::vector<std::string> names_of(const Study& study) {
  std::vector<std::string> names;
  for (const text::TableColumn& column : study.columns()) names.push_back(column.name);
  return names;
}

TEST(Study, RunsAGridOfDecays) {
  Plan plan = plan_of({{"x.in[1]", "-1..-3:3", {}}, {"x.initial", "0.5,1", {}}},
                      {"end(x)", "end(height)", "integral(x)", "max(y)"});
  const Study study = study_of(plan, kStudiedDecay);
  EXPECT_EQ(names_of(study), (std::vector<std::string>{"x.in[1]", "x.initial", "end(x)", "end(height)",
                                                       "integral(x)", "max(y)"}));
  ASSERT_EQ(study.runs(), 6U);
  const Study::Rows done = study.run(0, 6);
  ASSERT_EQ(done.rows.size(), 6U);
  EXPECT_EQ(done.count.failed, 0U);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::vector<double>& row = done.rows[k].values;
    const double rate = 1 + static_cast<double>(k / 2), height = k % 2 == 0 ? 0.5 : 1;
    EXPECT_EQ(row[0], -rate);
    EXPECT_EQ(row[1], height);
    // the run's tolerance, 1e-8, with a factor for its sum along the run
    EXPECT_NEAR(row[2], height * std::exp(-2 * rate), 1e-7);
    EXPECT_NEAR(row[3], 10 * height * std::exp(-2 * rate), 1e-6);
    EXPECT_NEAR(row[4], height * (1 - std::exp(-2 * rate)) / rate, 1e-7);
    EXPECT_NEAR(row[5], height * height, 1e-12);
  }
}

// x'' = −kx from 0.5 at rest: the first zero at π/2ω, ω = √k.
TEST(Study, FindsTheFrequencyOfASpring) {
  const Study study =
      study_of(plan_of({{"v.in[1]", "-4,-9,-16", {}}}, {"pi/2/time(x < 0)", "max(v)", "min(x)"}), kSpring);
  const Study::Rows done = study.run(0, 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const double omega = 2 + static_cast<double>(k);
    EXPECT_NEAR(done.rows[k].values[1], omega, 1e-6);
    EXPECT_NEAR(done.rows[k].values[2], 0.5 * omega, 1e-6);
    EXPECT_NEAR(done.rows[k].values[3], -0.5, 1e-7);
  }
}

TEST(Study, GivesTheSameRowsInChunksAndThreads) {
  Plan plan = plan_of({{"x.in[1]", "-3..-1", {}}, {"x.initial", "0.1..1:log", {}}}, {"end(x)"});
  plan.sampling = Sampling::latin_hypercube;
  plan.runs = 20;
  plan.scatter.push_back({"integrator", "tolerance", 0.01, {}});
  const Study study = study_of(plan, kStudiedDecay);
  const Study alone(plan, kStudiedDecay, testing::shipped_blocks(), 1);
  const Study::Rows all = study.run(0, 20), begin = alone.run(0, 7), rest = alone.run(7, 13);
  for (std::size_t k = 0; k < 20; ++k) {
    const StudyRow& part = k < 7 ? begin.rows[k] : rest.rows[k - 7];
    EXPECT_EQ(all.rows[k].number, k);
    EXPECT_EQ(all.rows[k].values, part.values);
  }
}

// dx/dt = −(1 + e)x, e uniform within ±1 %: log x(2)/−2 is uniform within 1 ± 1 %.
TEST(Study, DrawsElements) {
  Plan plan = plan_of({}, {"log(end(x))/-2 - 1"});
  plan.runs = 400;
  plan.scatter.push_back({"integrator", "tolerance", 0.01, {}});
  const Study study = study_of(plan, kStudiedDecay);
  EXPECT_EQ(study.n_drawn(), 1U);
  double sum = 0, squares = 0;
  for (const StudyRow& row : study.run(0, 400).rows) {
    EXPECT_LE(std::abs(row.values[0]), 0.01 + 1e-6);
    sum += row.values[0];
    squares += row.values[0] * row.values[0];
  }
  // four standard deviations of means over 400: of one on ±w w/√3, of its square w²·√(4/45)
  EXPECT_NEAR(sum / 400, 0, 4 * 0.01 / std::sqrt(3 * 400.0));
  EXPECT_NEAR(squares / 400, 1e-4 / 3, 4 * 1e-4 * std::sqrt(4.0 / 45 / 400));
}

TEST(Study, DrawsAlikeAtEveryCombination) {
  Plan plan = plan_of({{"x.initial", "0.5,1", {}}}, {"end(x)/start(x)"});
  plan.runs = 3;
  plan.scatter.push_back({"integrator", "tolerance", 0.01, {}});
  const Study study = study_of(plan, kStudiedDecay);
  ASSERT_EQ(study.runs(), 6U);
  const std::vector<StudyRow> rows = study.run(0, 6).rows;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(rows[k].values[0], 0.5);
    EXPECT_EQ(rows[k + 3].values[0], 1);
    EXPECT_NEAR(rows[k].values[1], rows[k + 3].values[1], 1e-7);  // the tolerance of the runs
  }
  EXPECT_GT(std::abs(rows[0].values[1] - rows[1].values[1]), 1e-5);
}

// 1 V on an RC of its own making: a composite whose parameter becomes a weight inside.
TEST(Study, VariesTheParametersOfComposites) {
  diagram::BlockLibrary library = testing::shipped_blocks_and("low-pass", R"toml(
[inputs]
in = {}
[outputs]
out = { wire = "v" }
[parameters]
rate = { default = 1, above = 0, doc = "1/RC" }
[blocks]
v = { type = "integrator", in = ["rate*in", "-rate*v"] }
)toml");
  const std::string text = R"toml(format = "oblique-diagram/1"
[blocks]
one = { type = "constant", value = 1 }
rc  = { type = "low-pass", in = "one" }
)toml";
  const Study study(plan_of({{"rc.rate", "1,2,5", {}}}, {"end(rc)", "end(rc.v)", "time(rc > 0.5)"}), text,
                    library, 1);
  const std::vector<StudyRow> rows = study.run(0, 3).rows;
  const double rates[]{1, 2, 5};
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(rows[k].failure, "");
    EXPECT_NEAR(rows[k].values[1], 1 - std::exp(-rates[k]), 1e-7);
    EXPECT_EQ(rows[k].values[2], rows[k].values[1]);
    EXPECT_NEAR(rows[k].values[3], std::log(2) / rates[k], 1e-6);
  }
}

// Weights p·p and p·q: the bounds of p alone, and of each name by itself, change nothing in the diagram.
TEST(Study, VariesWhatTheBoundsDoNotShow) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("product-of", R"(
summary = "out = p q x"
[inputs]
x = { doc = "d" }
[outputs]
out = { wire = "g" }
[parameters]
p = { default = 0, doc = "p" }
q = { default = 0, doc = "q" }
[blocks]
g = { type = "gain", in = "x", factor = "p*q" }
)");
  const std::string text = R"toml(format = "oblique-diagram/1"
[blocks]
one = { type = "constant" }
C = { type = "product-of", in = "one" }
x = { type = "integrator", in = ["C"] }
)toml";
  const Study study(plan_of({{"C.p", "0,1,2", {}}, {"C.q", "0,1,2", {}}}, {"end(x)"}), text, library, 1);
  const Study::Rows done = study.run(0, 9);
  ASSERT_EQ(done.rows.size(), 9U);
  for (const StudyRow& row : done.rows) {
    EXPECT_EQ(row.failure, "");
    EXPECT_NEAR(row.values[2], row.values[0] * row.values[1], 1e-7);
  }
}

TEST(Study, CountsTheMachinesThatRunWithAWarning) {
  // x′ = x(1 − x)(x − 2) rises from just above the unstable 1
  const std::string text = R"toml(format = "oblique-diagram/1"
[run]
until = 60
[blocks]
one = { type = "constant" }
a = { type = "summer", in = ["one", "-x"] }
b = { type = "summer", in = ["x", "-2*one"] }
xa = { type = "multiplier", in = ["x", "a"] }
xab = { type = "multiplier", in = ["xa", "b"] }
x = { type = "integrator", in = ["xab"], initial = 1.5 }
)toml";
  const Study study = study_of(plan_of({{"x.initial", "1.00000000000001,1.5", {}}}, {"end(x)"}), text);
  const Study::Rows done = study.run(0, 2);
  EXPECT_EQ(done.count.warned, 1U);
  ASSERT_TRUE(done.count.first_warned);
  EXPECT_EQ(done.count.first_warned->first, 0U);
  EXPECT_NE(done.count.first_warned->second.find("unstable"), std::string::npos);
}

// A signal that is no output of the diagram is called by its own name: y = e^t, of which no digit is known
// where 1 − x = e^(−t) has come to the errors of x.
TEST(Study, NamesASignalThatIsMeasuredInAWarning) {
  const std::string text = R"toml(format = "oblique-diagram/1"
[run]
until = 28
[blocks]
one = { type = "constant" }
x = { type = "integrator", in = ["one", "-x"] }
d = { type = "summer", in = ["one", "-x"] }
y = { type = "divider", numerator = "1e-12*one", denominator = "d", gain = inf, bandwidth = inf }
)toml";
  const Study study = study_of(plan_of({{"x.initial", "0", {}}}, {"end(y)"}), text);
  const Study::Rows done = study.run(0, 1);
  ASSERT_TRUE(done.count.first_warned);
  EXPECT_NE(done.count.first_warned->second.find("no digit of the output 'y' is known"), std::string::npos)
      << done.count.first_warned->second;
}

TEST(Study, EndsAtEveryOutputWhereNothingIsAsked) {
  const Study study = study_of(plan_of({{"x.initial", "1,2", {}}}, {}), kStudiedDecay);
  EXPECT_EQ(names_of(study), (std::vector<std::string>{"x.initial", "end(height)"}));
}

TEST(Study, TellsOfAMachineThatFails) {
  const Study study = study_of(plan_of({{"x.in[1]", "-1,1e300", {}}}, {"end(x)"}), kStudiedDecay);
  const Study::Rows done = study.run(0, 2);
  EXPECT_EQ(done.rows[0].failure, "");
  EXPECT_NE(done.rows[1].failure, "");
  EXPECT_TRUE(std::isnan(done.rows[1].values[1]));
  EXPECT_EQ(done.rows[1].values[0], 1e300);
  EXPECT_EQ(done.count.failed, 1U);
}

TEST(Study, KeepsWhatIsDoneWhenItIsInterrupted) {
  const Study study(plan_of({{"x.initial", "1..2:100", {}}}, {"end(x)"}), kStudiedDecay,
                    testing::shipped_blocks(), 1);
  int asked = 0;
  const Study::Rows done = study.run(0, 100, {}, [&] { return ++asked > 30; });
  EXPECT_GE(done.rows.size(), 1U);
  EXPECT_LT(done.rows.size(), 100U);
  for (const StudyRow& row : done.rows) EXPECT_FALSE(std::isnan(row.values[1]));
}

TEST(Family, RunsEachValue) {
  const diagram::Diagram diagram = diagram::parse_diagram(kStudiedDecay, "d.toml");
  solve::RunOptions options = solve::options_of(diagram.run);
  options.samples = 21;
  const Family family = run_family(diagram, testing::shipped_blocks(), {{"x.initial", "2"}},
                                   {"x.in[1]", "-1..-3:3", {}}, options, 2);
  ASSERT_EQ(family.runs.size(), 3U);
  EXPECT_EQ(family.label(1), "x.in[1] = -2");
  for (std::size_t k = 0; k < 3; ++k) {
    const solve::Trajectory& rows = family.runs[k].run.trajectory;
    ASSERT_EQ(rows.rows(), 21U);
    for (std::size_t r = 0; r < 21; ++r) {
      const double exact = 20 * std::exp(-(1 + static_cast<double>(k)) * rows.at(r, 0));
      EXPECT_NEAR(rows.at(r, 1), exact, 2e-6);  // ten times the run's tolerance of 1e-8, of 20 m
    }
  }
  EXPECT_EQ(testing::message_of<StudyError>([&] {
              run_family(diagram, testing::shipped_blocks(), {}, {"x.in[3]", "1,2", {}}, options, 1);
            }),
            "input 'x.in' has no wire 3; expected 1");
}

constexpr const char* kFourBar = R"toml(format = "oblique-mechanism/1"
title = "Crank and rocker"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB  = { points = ["A", "B"], length = 1 }
BCM = { points = ["B", "C"], length = 3.5, marks = { M = [1.75, 1] } }
CD  = { points = ["C", "D"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = "1 rad/s", start = "0 deg" }
[sketch]
C = [3.5, 2.9]
)toml";

Plan mechanism_plan(std::vector<Variation> vary, std::vector<std::string> measures) {
  Plan plan = plan_of(std::move(vary), std::move(measures));
  plan.mechanism = true;
  return plan;
}

// At the start, and after a turn, B is at (a, 0): C stands above the middle of BD, by Pythagoras.
TEST(Study, VariesTheDimensionsOfAMechanism) {
  const Study study =
      study_of(mechanism_plan(
                   {{"AB.length", "0.8,1,1.2", {}}, {"gain", "1e3..1e5:3:log", {}}},
                   {"error()", "rms_error()", "end(exact(C.x))", "end(exact(C.y))", "end(C.x)", "min(B.x)"}),
               kFourBar);
  EXPECT_EQ(names_of(study)[0], "AB.length");
  EXPECT_EQ(study.columns()[0].unit, "m");
  EXPECT_EQ(study.columns()[2].unit, "m");
  const Study::Rows done = study.run(0, 9);
  ASSERT_EQ(done.count.failed, 0U) << done.rows[0].failure;
  EXPECT_EQ(done.count.reasons.count("its diagram differs in more than numbers"), 0U);
  for (std::size_t k = 0; k < 9; ++k) {
    const std::vector<double>& row = done.rows[k].values;
    const double a = row[0], d = 4 - a, x = (d * d + 3.5 * 3.5 - 9) / (2 * d);
    EXPECT_NEAR(row[4], a + x, 1e-13);
    EXPECT_NEAR(row[5], std::sqrt(3.5 * 3.5 - x * x), 1e-13);
    EXPECT_LE(std::abs(row[6] - row[4]), row[2]);
    EXPECT_LE(row[3], row[2]);
    EXPECT_NEAR(row[7], -a, 2e-9);  // the run's tolerance, 1e-10, along a turn
    // the error of a servo loop is in proportion to 1/gain
    if (k % 3 > 0) {
      EXPECT_NEAR(row[2] / done.rows[k - 1].values[2], 0.1, 1e-3);
    }
  }
}

TEST(Study, TellsWhichMechanismCannotBe) {
  const Study study = study_of(mechanism_plan({{"CD", "3,9", {}}, {"gain", "1e3,1e4", {}}}, {}), kFourBar);
  EXPECT_EQ(names_of(study), (std::vector<std::string>{"CD", "gain", "error()"}));
  const std::vector<StudyRow> rows = study.run(0, 4).rows;
  EXPECT_EQ(rows[0].failure, "");
  EXPECT_EQ(rows[2].failure.find("dyad 'BCM-CD' cannot be assembled at the start: "), 0U) << rows[2].failure;
  EXPECT_EQ(rows[2].failure, rows[3].failure);
  EXPECT_TRUE(std::isnan(rows[3].values[2]));
}

// Of four machines two cannot be made: what is done never is more than there is, and comes to all of it.
TEST(Study, CountsMechanismsThatAreDone) {
  const Study study = study_of(mechanism_plan({{"CD", "3,9", {}}, {"gain", "1e3,1e4", {}}}, {}), kFourBar);
  std::vector<std::uint64_t> done;
  study.run(0, 4, [&](std::uint64_t n) { done.push_back(n); });
  ASSERT_FALSE(done.empty());
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.back(), 4U);
}

TEST(Study, GivesTheSameMechanismsInChunks) {
  Plan plan = mechanism_plan({{"AB", "0.9..1.1", {}}, {"BCM.M.x", "1..2", {}}}, {"error()"});
  plan.sampling = Sampling::sobol;
  plan.runs = 10;
  plan.tolerance_of_elements = 0.001;
  plan.samples = 37;
  const Study study = study_of(plan, kFourBar);
  EXPECT_GT(study.n_drawn(), 10U);
  const std::vector<StudyRow> all = study.run(0, 10).rows, part = study.run(6, 3).rows;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(part[k].values, all[6 + k].values);
  for (const StudyRow& row : all) {
    EXPECT_EQ(row.failure, "");
    EXPECT_GT(row.values[2], 1e-5);  // elements of 0.1 % leave far more than the gain of 1e6
    EXPECT_LT(row.values[2], 0.1);
  }
}

// Where nothing but its elements changes the mechanism is patched once.
TEST(Study, DrawsTheElementsOfOneMechanism) {
  Plan plan = mechanism_plan({}, {"error()", "end(exact(C.x))"});
  plan.runs = 40;
  plan.tolerance_of_elements = 0.001;
  plan.samples = 37;
  const Study study = study_of(plan, kFourBar), alone(plan, kFourBar, testing::shipped_blocks(), 1);
  const std::vector<StudyRow> rows = study.run(0, 40).rows, some = alone.run(11, 5).rows;
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(some[k].values, rows[11 + k].values);
  plan.vary.push_back({"AB", "1,1", {}});  // the same mechanism, patched for each machine
  const std::vector<StudyRow> patched = study_of(plan, kFourBar).run(0, 40).rows;
  for (std::size_t k = 0; k < 40; ++k) {
    EXPECT_GT(rows[k].values[0], 1e-5);
    EXPECT_NEAR(patched[k].values[1], rows[k].values[0], 1e-9);  // the tolerance of the runs
    EXPECT_EQ(patched[k].values[2], rows[k].values[1]);
  }
}

TEST(Study, RefusesNamesThatNoMechanismHas) {
  const auto message = [](const char* name, const char* measure) {
    return testing::message_of<StudyError>([&] {
      study_of(mechanism_plan({{name, "1,2", {}}}, {measure}), kFourBar);
    });
  };
  EXPECT_EQ(message("AC", "error()"), "'AC' is no dimension of the mechanism\n  remedy: did you mean 'AB'?");
  EXPECT_EQ(message("BCM.M", "error()"), "'BCM.M' is 2 numbers; expected one of BCM.M.x, BCM.M.y");
  EXPECT_EQ(message("AB", "end(exact(C.z))"),
            "measure 'end(exact(C.z))': the exact motion has no column 'C.z'\n  remedy: did you mean 'C.x'?");
  EXPECT_EQ(message("AB", "end(C.q)"),
            "measure 'end(C.q)': there is no output or signal 'C.q'\n  remedy: did you mean 'C.x'?");
}

struct BadPlan {
  std::string name, values, measure, message;
};

TEST(Study, RefusesWhatMakesNoSense) {
  const BadPlan bad[]{
      {"z.initial", "1,2", "end(x)", "there is no block 'z'; remedy"},
      {"x.initiall", "1,2", "end(x)",
       "'initiall' of block type 'integrator' is not a parameter\n"
       "  remedy: did you mean 'initial'?"},
      {"x.initial", "", "end(x)",
       "values of 'x.initial': there are no values; expected a list such as 1,2,5, or a range such as "
       "0.8..1.2:9"},
      {"x.initial", "1,,2", "end(x)",
       "values of 'x.initial': '1,,2' has a comma and no value beside it; expected a value"},
      {"x.initial", "-1..1:5:log", "end(x)",
       "values of 'x.initial': a logarithmic range cannot go from -1 to 1; expected both bounds above 0, or "
       "both below"},
      {"x.initial", "0..1:1.5", "end(x)",
       "values of 'x.initial': '1.5' in '0..1:1.5' is no number of values; expected a whole number from 2 to "
       "1000000, and ':log' for even steps of the logarithm"},
      {"x.initial", "0..1", "end(x)",
       "the range '0..1' of 'x.initial' does not say how many values it has; expected '0..1:5', for example"},
      {"x.initial", "1..1:3", "end(x)",
       "values of 'x.initial': the range '1..1:3' has equal bounds; expected two bounds\n"
       "  remedy: the value alone: 1"},
      {"x.initial", "1 Hz,2", "end(x)", "values of 'x.initial': '1 Hz': "},
      {"x.initial", "1,2", "end(hight)",
       "measure 'end(hight)': there is no output or signal 'hight'\n  remedy: did you mean 'height'?"},
      {"x.initial", "1,2", "x",
       "measure 'x': 'x' has a value at every moment, and a measure is one number of a run; expected end(x), "
       "max(x), mean(x) …"},
  };
  for (const BadPlan& one : bad) {
    const std::string message = testing::message_of<StudyError>([&] {
      study_of(plan_of({{one.name, one.values, {}}}, {one.measure}), kStudiedDecay);
    });
    if (one.message.ends_with("; remedy")) {
      EXPECT_NE(message.find(one.message.substr(0, one.message.size() - 8)), std::string::npos) << message;
    } else {
      EXPECT_EQ(message.substr(0, one.message.size()), one.message);
    }
  }
}

TEST(Study, NamesAllFindingsAtTheirPlaces) {
  Plan plan =
      plan_of({{"x.initial", "1,2", {"p.toml", {4, 13}}}, {"x.initial", "1,2", {"p.toml", {5, 13}}}}, {});
  plan.measures.push_back({"m", "end(zz)", {"p.toml", {7, 5}}});
  const std::string message = testing::message_of<StudyError>([&] { study_of(plan, kStudiedDecay); });
  EXPECT_NE(message.find("p.toml:5:13: 'x.initial' is varied twice"), std::string::npos) << message;
  EXPECT_NE(message.find("p.toml:7:10: measure 'end(zz)': there is no output or signal 'zz'"),
            std::string::npos)
      << message;
}

// In a plan all widths are read as numbers without a unit: a percentage is then none of 1/s.
TEST(Study, RefusesAPercentageOfWhatHasAUnit) {
  Plan plan = plan_of({}, {"end(x)"});
  plan.runs = 3;
  plan.scatter.push_back({"integrator", "rate", 0.1, {}, true});
  EXPECT_EQ(testing::message_of<StudyError>([&] { study_of(plan, kStudiedDecay); }),
            "'integrator.rate' is in 1/s, and 10 % is not; expected half the width in 1/s, without %");
  plan.scatter[0].in_percent = false;
  EXPECT_NO_THROW(study_of(plan, kStudiedDecay));
}

// A setting lies between 0 and 1: nothing is drawn beyond, and nothing mirrored, also not where it is varied
// to.
TEST(Study, RefusesScatterBeyondTheRangeOfAParameter) {
  const char* const kDivider = R"toml(format = "oblique-diagram/1"
title  = "divider"
[run]
until = 1
[blocks]
one = { type = "constant" }
p   = { type = "potentiometer", in = "one", setting = 0.5 }
[outputs]
p = "p"
)toml";
  Plan plan = plan_of({}, {"end(p)"});
  plan.runs = 3;
  plan.scatter.push_back({"potentiometer", "setting", 0.6, {}});
  const auto message = [&] { return testing::message_of<StudyError>([&] { study_of(plan, kDivider); }); };
  EXPECT_EQ(message(),
            "'p.setting' is 0.5, and scatters by ±0.6; expected a half width that keeps it a number at least "
            "0 and at most 1");
  plan.scatter[0].half_width = 0.25;
  plan.vary = {{"p.setting", "0.3,0.8", {}}};
  EXPECT_EQ(message(),
            "'p.setting' is 0.8, and scatters by ±0.25; expected a half width that keeps it a number at "
            "least 0 and at most 1");
  plan.vary = {{"p.setting", "0.3,0.75", {}}};
  EXPECT_EQ(study_of(plan, kDivider).runs(), 6U);
}

TEST(Study, RefusesNumbersOfRunsThatMakeNoSense) {
  const auto message = [](Plan plan) {
    return testing::message_of<StudyError>([&] { study_of(plan, kStudiedDecay); });
  };
  Plan plan = plan_of({{"x.initial", "1,2", {}}}, {});
  plan.runs = 5;
  EXPECT_EQ(message(plan),
            "5 runs of each combination would be the same one; expected no number of runs with a grid, or "
            "elements that scatter");
  plan.runs.reset();
  plan.sampling = Sampling::sobol;
  EXPECT_EQ(message(plan), "it is not said how many points are to be chosen; expected a number of runs");
  EXPECT_EQ(
      message(plan_of({}, {})),
      "nothing is varied and nothing scatters, so that all machines are one; expected names with values, "
      "such as c.gain=1e2..1e6:5:log");
  Plan scattered = plan_of({}, {});
  scattered.runs = 3;
  scattered.scatter.push_back({"summer", "tolerance", 0.01, {}});
  EXPECT_EQ(message(scattered).substr(0, 58), "no block of the diagram is a 'summer', so that none scatte");
}

}  // namespace
}  // namespace oblique::ensemble
