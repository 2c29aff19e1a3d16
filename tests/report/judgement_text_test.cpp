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

// An excess of a few millionths is one: in digits of the signal it would read as 1.
TEST(JudgementText, SaysHowFarASignalGoesBeyondTheMachineUnit) {
  commission::DiagramOnMachine patched;
  patched.overloads = {{"x", 1.00004}, {"y", 1.00001}};
  diagram::MachineProfile machine;
  machine.title = "Machine";
  EXPECT_TRUE(
      machine_text(patched, machine)
          .ends_with("\nwarning: on the elements of Machine 'x' goes 0.004 % beyond the machine unit\n"));
}

TEST(JudgementText, WarnsOfOutputsThatAreSomethingElse) {
  const diagram::MachineProfile& machine = *diagram::find_machine("tr-48");
  commission::DiagramOnMachine patched;
  const auto warning = [&] {
    const std::string text = machine_text(patched, machine);
    const std::size_t at = text.find("warning: ");
    return at == std::string::npos ? "" : text.substr(at);
  };
  patched.difference = 1e-4;
  EXPECT_EQ(warning(), "");
  patched.difference = 2e-3;
  EXPECT_EQ(warning(),
            "warning: that is more than the solver's tolerance explains, unless the diagram is chaotic or "
            "gives its "
            "elements errors of their own, which weigh otherwise in another scale\n");
  patched.made.functions.push_back({"f", "sine", 10, 0, 1, 0.01});
  EXPECT_EQ(warning(), "");
  patched.difference = 0.1;
  EXPECT_EQ(warning(),
            "warning: the straight lines make something else of it, unless the diagram is chaotic; with more "
            "of them "
            "it may be less\n");
  patched.given_up = true;
  EXPECT_THAT(warning(),
              ::testing::EndsWith("warning: on the elements of EAI PACE TR-48 (1961) its run takes more than "
                                  "200000 steps, and was given up: whether signals leave the machine unit "
                                  "there is not told\n"));
  patched.published_left_out = 1;
  EXPECT_THAT(
      machine_text(patched, machine),
      ::testing::HasSubstr("1 published value that sets something of the diagram is not taken along\n"));
  patched.published_left_out = 2;
  EXPECT_THAT(
      machine_text(patched, machine),
      ::testing::HasSubstr("2 published values that set something of the diagram are not taken along\n"));
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

TEST(SettingsText, TellsThreeWithTheirStepAndRemedyAndNamesTheRest) {
  const diagram::MachineProfile& machine = *diagram::find_machine("tr-10");
  EXPECT_EQ(settings_text({}, machine), "");
  // Half a step, 0.000125, is 15.6 % of 0.0008; 0.0283² = 0.0008.
  const machine::CoarseSetting coarse{"P3", "pot_3", 0.0008, 0.00025, true, 2};
  const std::string first =
      "warning: P3 ('pot_3') is set to 0.0008, and the potentiometers of EAI PACE TR-10 (1959) have steps of "
      "0.00025: it may be off by 16 %\n"
      "  remedy: scale the signals so that it is larger, or put 2 potentiometers in series, each at 0.0283\n";
  EXPECT_EQ(settings_text({coarse}, machine), first);
  const machine::CoarseSetting fourth{"P7", "pot_7", 0.001, 0.00025, true, 2},
      fifth{"P9", "pot_9", 0.001, 0.00025, true, 2};
  EXPECT_EQ(settings_text({coarse, coarse, coarse, fourth, fifth}, machine),
            first + first + first + "warning: as small are the settings of P7, P9\n");
  EXPECT_EQ(settings_text({{"P1", "pot_1", -1e-8, 1e-4, false, 3}}, *diagram::find_machine("model-1")),
            "warning: P1 ('pot_1') is set to -1e-08, and the pot sheet has steps of 0.0001 (those of Analog "
            "Paradigm Model-1 are not published): it may be off by 100 %\n"
            "  remedy: scale the signals so that it is larger, or put 3 potentiometers in series, each at "
            "0.00215\n");
}

TEST(BandwidthText, IsForSlowerAmplifiersOnly) {
  commission::MachinePatch patch;
  const diagram::MachineProfile& machine = *diagram::find_machine("ec-1");
  EXPECT_EQ(bandwidth_text(patch, machine), "");
}

}  // namespace
}  // namespace oblique::report
