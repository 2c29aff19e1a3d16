// SPDX-License-Identifier: MIT
#include <oblique/report/judgement_text.h>

#include <limits>

#include <gtest/gtest.h>

namespace oblique::report {
namespace {

commission::Judgement good() {
  commission::Judgement judgement;
  judgement.slowest_pole = -250;
  judgement.largest_signal = "crank.cos";
  judgement.largest = 1;
  return judgement;
}

TEST(JudgementText, SaysThatTheLoopsSettleAndHowLargeSignalsAre) {
  EXPECT_EQ(judgement_text(good()),
            "its servo loops come to rest everywhere: slowest pole -250 1/s, damping ζ ≥ 1; largest signal 1 "
            "(crank.cos)\n");
  commission::Judgement none = good();
  none.slowest_pole = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(judgement_text(none), "no servo loops; largest signal 1 (crank.cos)\n");
}

TEST(JudgementText, WarnsOfAnOverloadBeyondTheErrorsOfElements) {
  commission::Judgement judgement = good();
  judgement.largest = 1.01;
  EXPECT_EQ(judgement_text(judgement).find("warning"), std::string::npos);
  judgement.largest = 1.5;
  const text::Vocabulary options{[](const text::Setting& s) { return "--" + s.name; }, {}};
  EXPECT_TRUE(judgement_text(judgement, options)
                  .ends_with("\nwarning: it overloads the machine; choose a larger --unit\n"));
}

TEST(JudgementText, NamesTheLoopsThatDoNotSettle) {
  commission::Judgement judgement = good();
  judgement.swinging = {"c", "s"};
  judgement.damping = 0.01;
  EXPECT_TRUE(judgement_text(judgement).ends_with("; a run takes many steps\n"));
  EXPECT_NE(
      judgement_text(judgement).find(
          "warning: it is badly damped: the loops 'c', 's' oscillate for long before they settle (ζ = 0.01)"),
      std::string::npos)
      << judgement_text(judgement);
  judgement.grows_from = 0.5;
  judgement.slowest_pole = 12;
  judgement.pole_time = 0.5;
  judgement.growing = {"c"};
  EXPECT_EQ(judgement_text(judgement),
            "warning: it is unstable: the loops 'c' diverge, at 12 1/s at t = 0.5 s\n");
}

TEST(BandwidthText, IsForSlowerAmplifiersOnly) {
  commission::MachinePatch patch;
  const diagram::MachineProfile& machine = *diagram::find_machine("ec-1");
  EXPECT_EQ(bandwidth_text(patch, machine), "");
}

}  // namespace
}  // namespace oblique::report
