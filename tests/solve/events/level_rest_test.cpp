// SPDX-License-Identifier: MIT
// Comparisons of what rests at their level: thyristors that cut off the current which they compare.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::row_values;
using testing::run_of;
using ::testing::SizeIs;

/// 0.3 di/dt = sin 2πt − i where either thyristor is on; they fire at 0.2 and 0.7 of each period.
constexpr double kLag = 0.3, kFires = 0.2;

/// In closed form, of the first half-wave from where it fires.
double half_wave(double t) {
  constexpr double kOmega = 2 * std::numbers::pi;
  const auto steady = [](double at) {
    return (std::sin(kOmega * at) - kOmega * kLag * std::cos(kOmega * at)) /
           (1 + kOmega * kLag * kOmega * kLag);
  };
  return steady(t) - steady(kFires) * std::exp(-(t - kFires) / kLag);
}

double current(double t) {
  double low = 0.5, high = kFires + 0.5;  // it ends in between
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (half_wave(middle) > 0 ? low : high) = middle;
  }
  const double half = std::floor(2 * (t - kFires)), since = t - half / 2;  // half-waves
  return half < 0 || since > low ? 0 : (static_cast<int>(half) % 2 == 0 ? 1 : -1) * half_wave(since);
}

const std::vector<std::string> kLoad{
    "u = { type = \"sine-source\" }\n",
    "d = { type = \"summer\", in = [\"u\", \"-i\"] }\n",
    "di = { type = \"multiplier\", x = \"d\", y = \"on\" }\n",
    "i = { type = \"integrator\", in = \"di\", rate = \"1/0.3\" }\n",
    "fire1 = { type = \"pulse-train\", period = 1, width = 1e-3, delay = 0.2 }\n",
    "fire2 = { type = \"pulse-train\", period = 1, width = 1e-3, delay = 0.7 }\n"};

/// The blocks in their order and in the reverse one.
std::vector<Compiled> both_orders(std::vector<std::string> blocks) {
  blocks.insert(blocks.end(), kLoad.begin(), kLoad.end());
  std::vector<Compiled> made;
  for (int k = 0; k < 2; ++k) {
    std::string text;
    for (const std::string& block : blocks) text += block;
    made.emplace_back(text);
    std::reverse(blocks.begin(), blocks.end());
  }
  return made;
}

void expect_current(const solve::Run& run, bool both_ways = true) {
  const std::vector<double> t = row_values(run, "t"), i = row_values(run, "i");
  // The errors of the steps, and of the times at which it fires, add up to some ten tolerances of 1e-8.
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_NEAR(i[k], both_ways ? current(t[k]) : std::max(current(t[k]), 0.0), 1e-6) << t[k];
}

const std::vector<std::string> kLatches{
    "on1 = { type = \"flip-flop\", set = \"fire1\", reset = \"dead1\" }\n",
    "on2 = { type = \"flip-flop\", set = \"fire2\", reset = \"dead2\" }\n",
    "on = { type = \"summer\", in = [\"on1.out\", \"on2.out\"] }\n",
    "dead1 = { type = \"comparator\", in = \"-i\" }\n", "dead2 = { type = \"comparator\", in = \"i\" }\n"};

// Neither comparison holds while the current rests at zero, and each thyristor fires anew. That which ended
// the half-wave, and would hold by the least offset, is that of the other one.
TEST(LevelRest, LetsLatchesFireThatTheirOwnTurnsHaveReset) {
  for (const Compiled& made : both_orders(kLatches)) {
    const solve::Run run = run_of(made, {.until = 4, .samples = 401});
    expect_current(run);
    EXPECT_THAT(run.warnings, IsEmpty());
  }
}

// One thyristor alone fires anew too. On a machine the least offset would hold it in reset, which is told.
TEST(LevelRest, IsToldOfWhereALatchReadsIt) {
  const std::vector<std::string> blocks{
      "on1 = { type = \"flip-flop\", set = \"fire1\", reset = \"dead1\" }\n",
      "on = { type = \"summer\", in = [\"on1.out\"] }\n", "dead1 = { type = \"comparator\", in = \"-i\" }\n"};
  for (const Compiled& made : both_orders(blocks)) {
    const solve::Run run = run_of(made, {.until = 4, .samples = 401});
    expect_current(run, false);
    ASSERT_THAT(run.warnings, SizeIs(1));
    EXPECT_THAT(
        run.warnings.front().what,
        HasSubstr("'dead1' (in > 0) rests at its level from t = 0.666564441 s on, where its own turn has "
                  "stopped what it compares, and at t = 1.2 s what follows depends on it"));
    EXPECT_THAT(run.warnings.front().remedy.words(), HasSubstr("give the comparison a hysteresis"));
  }
}

// A reset that is not read while the gate fires: what the comparison does at rest is all the same.
TEST(LevelRest, IsNotToldOfWhereNothingDependsOnIt) {
  std::vector<std::string> blocks{kLatches[2], kLatches[3], kLatches[4]};
  for (const std::string n : {"1", "2"}) {
    blocks.push_back("on" + n + " = { type = \"flip-flop\", set = \"fire" + n + "\", reset = \"blocked" + n +
                     "\" }\n");
    blocks.push_back("free" + n + " = { type = \"comparator\", in = [\"0.5*one\", \"-fire" + n + "\"] }\n");
    blocks.push_back("blocked" + n + " = { type = \"minimum\", x = \"dead" + n + "\", y = \"free" + n +
                     "\" }\n");
  }
  blocks.emplace_back("one = { type = \"constant\" }\n");
  for (const Compiled& made : both_orders(blocks)) {
    const solve::Run run = run_of(made, {.until = 4, .samples = 401});
    expect_current(run);
    EXPECT_THAT(run.warnings, IsEmpty());
  }
}

// The same by comparisons alone: each thyristor conducts while its current flows or it fires. On either side
// of zero the current goes on through it; at zero neither conducts, and it stops there, which is told.
TEST(LevelRest, StopsWhatNeitherOfTwoComparisonsCarriesOn) {
  const std::vector<std::string> blocks{"flows1 = { type = \"comparator\", in = \"i\" }\n",
                                        "flows2 = { type = \"comparator\", in = \"-i\" }\n",
                                        "on1 = { type = \"maximum\", x = \"flows1\", y = \"fire1\" }\n",
                                        "on2 = { type = \"maximum\", x = \"flows2\", y = \"fire2\" }\n",
                                        "on = { type = \"maximum\", x = \"on1\", y = \"on2\" }\n"};
  for (const Compiled& made : both_orders(blocks)) {
    const solve::Run run = run_of(made, {.until = 4, .samples = 401});
    expect_current(run);
    ASSERT_THAT(run.warnings, SizeIs(1));
    EXPECT_THAT(run.warnings.front().what, HasSubstr(" (in > 0) stops at its level at t = "));
    EXPECT_THAT(run.warnings.front().what, HasSubstr("the least offset lets it go on"));
  }
}

}  // namespace
}  // namespace oblique::solve
