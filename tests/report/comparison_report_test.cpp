// SPDX-License-Identifier: MIT
#include <oblique/report/comparison_report.h>

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace oblique::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Two runs by triangles; the second leaves its branch at 90° and errs most at 180°.
compare::Comparison two_runs() {
  compare::Comparison comparison;
  comparison.mechanism = "Four-bar";
  comparison.unit = "m";
  comparison.size = 4;
  comparison.drive = {0, std::numbers::pi / 2, std::numbers::pi};
  comparison.runs.resize(2);
  comparison.runs[0].gain = 1e3;
  comparison.runs[0].max_error = 2e-3;
  comparison.runs[1].gain = 1e4;
  comparison.runs[1].max_error = 3;
  for (compare::ComparedRun& run : comparison.runs) run.worst = {"C", 1, std::numbers::pi, ""};
  comparison.runs[1].left_branch = std::numbers::pi / 2;
  comparison.series = {{patch::PatchMethod::triangles, 0, 0, 2, 1e-9, {}}};
  return comparison;
}

TEST(ComparisonReport, SaysWhichRunLeftItsBranchAndWhereThatBegins) {
  const std::string text = to_text(two_runs());
  EXPECT_THAT(
      text,
      HasSubstr("wrong branch at gain 10000: its loops hold another assembly mode from 90° on; that is no "
                "error of the gain, and not in its order\n"));
  EXPECT_THAT(text, Not(HasSubstr("wrong branch at gain 1000:")));
  EXPECT_THAT(text, HasSubstr("other mode"));
  const auto json = to_json(two_runs(), false);
  EXPECT_TRUE(json["runs"][0]["left_branch"].is_null());
  EXPECT_EQ(json["runs"][1]["left_branch"], std::numbers::pi / 2);
}

TEST(ComparisonReport, TellsWhereAPatchLeavesItsBranch) {
  mechanism::Mechanism mechanism;
  mechanism.length_unit = "mm";
  mechanism.drives.resize(1);
  mechanism.drives.front().name = "crank";
  EXPECT_EQ(
      left_branch_text(mechanism, -std::numbers::pi / 2),
      "warning: its run goes over into another assembly mode, from crank = 270° on, and its points are "
      "not the mechanism's then: it passes too near a dead centre; 'compare' tells how other methods and "
      "gains do\n");
  mechanism.drives.front().slide = 0;
  EXPECT_THAT(left_branch_text(mechanism, 12.5), HasSubstr("from crank = 12.5 mm on"));
}

}  // namespace
}  // namespace oblique::report
