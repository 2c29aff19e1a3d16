// SPDX-License-Identifier: MIT
#include <oblique/text/diagnostic.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique {
namespace {

TEST(Diagnostic, PrintsPlaceFindingExpectationAndRemedy) {
  const Diagnostic diagnostic{
      {"four-bar.toml", {4, 7}}, "'length' is a table", "a number", "write length = 80"};
  EXPECT_EQ(to_string(diagnostic),
            "four-bar.toml:4:7: 'length' is a table; expected a number\n  remedy: write length = 80");
}

TEST(Diagnostic, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(to_string(Diagnostic{{"a.toml", {}}, "cannot open the file", {}, {}}),
            "a.toml: cannot open the file");
  EXPECT_EQ(to_string(Diagnostic{{}, "there is no block", {}, {}}), "there is no block");
}

TEST(Error, JoinsItsDiagnostics) {
  const Error error({{{"a", {1, 1}}, "first", {}, {}}, {{"a", {2, 1}}, "second", {}, {}}});
  EXPECT_STREQ(error.what(), "a:1:1: first\na:2:1: second");
  EXPECT_EQ(error.diagnostics().size(), 2U);
}

TEST(Diagnostics, ThrowsNothingWhenEmpty) {
  Diagnostics diagnostics;
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_NO_THROW(diagnostics.throw_if_any<ReadError>());
}

TEST(Diagnostics, ThrowsEverythingInTheOrderOfTheFile) {
  Diagnostics diagnostics;
  diagnostics.add({{"b", {1, 1}}, "in another file", {}, {}});
  diagnostics.add({{"a", {10, 2}}, "late", {}, {}});
  diagnostics.add({{"a", {9, 30}}, "early", {}, {}});
  diagnostics.add({{"a", {9, 30}}, "same place", {}, {}});
  EXPECT_EQ(diagnostics.size(), 4U);
  EXPECT_THAT([&] { diagnostics.throw_if_any<ReadError>(); },
              testing::ThrowsMessage<ReadError>(
                  "a:9:30: early\na:9:30: same place\na:10:2: late\nb:1:1: in another file"));
}

TEST(NearestName, FindsASlipOfTheHand) {
  const std::vector<std::string> names{"integrator", "summer", "multiplier"};
  EXPECT_EQ(nearest_name("integratr", names), "integrator");
  EXPECT_EQ(nearest_name("sumer", names), "summer");
  EXPECT_EQ(nearest_name("multilpier", names), "multiplier");
}

TEST(NearestName, DoesNotGuessAtWhatIsFarAway) {
  EXPECT_EQ(nearest_name("comparator", {"integrator", "summer"}), std::nullopt);
  EXPECT_EQ(nearest_name("x", {"y", "in"}), std::nullopt) << "replacing all of a name is no slip";
  EXPECT_EQ(nearest_name("anything", {}), std::nullopt);
}

TEST(Suggest, NamesTheNearestOrListsTheKnown) {
  EXPECT_EQ(suggest("gian", {"gain", "bandwidth"}), "did you mean 'gain'?");
  EXPECT_EQ(suggest("colour", {"gain", "bandwidth"}), "known: gain, bandwidth");
  EXPECT_EQ(suggest("colour", {}), "");
}

TEST(Suggest, KeepsALongListShort) {
  std::vector<std::string> names;
  for (int i = 0; i < 15; ++i) names.push_back("block" + std::to_string(i));
  EXPECT_EQ(suggest("zzzzzzzzz", names),
            "known: block0, block1, block2, block3, block4, block5, block6, block7, block8, block9, block10, "
            "block11 "
            "and 3 more");
}

}  // namespace
}  // namespace oblique
