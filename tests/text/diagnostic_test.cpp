// SPDX-License-Identifier: MIT
#include <oblique/text/diagnostic.h>

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::text {
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
              ::testing::ThrowsMessage<ReadError>(
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

/// The definition, letter by letter: what remains of a from i on and of b from j on.
std::size_t slips(const std::string& a, const std::string& b, std::size_t i = 0, std::size_t j = 0) {
  if (i == a.size()) return b.size() - j;
  if (j == b.size()) return a.size() - i;
  std::size_t least = slips(a, b, i + 1, j + 1) + (a[i] == b[j] ? 0 : 1);
  least = std::min({least, slips(a, b, i + 1, j) + 1, slips(a, b, i, j + 1) + 1});
  if (i + 1 < a.size() && j + 1 < b.size() && a[i] == b[j + 1] && a[i + 1] == b[j])
    least = std::min(least, slips(a, b, i + 2, j + 2) + 1);
  return least;
}

TEST(NearestName, IsTheOneWithTheFewestSlips) {
  std::mt19937 random(7);
  const auto word = [&] {
    std::string text(3 + random() % 5, ' ');
    for (char& c : text) c = "abc"[random() % 3];
    return text;
  };
  for (int k = 0; k < 300; ++k) {
    const std::string name = word();
    const std::vector<std::string> candidates{word(), word(), word()};
    std::optional<std::string> nearest;
    std::size_t fewest = std::max<std::size_t>(1, name.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
      const std::size_t n = slips(name, candidate);
      if (n < fewest && n < candidate.size()) nearest = candidate;
      if (n < fewest && n < candidate.size()) fewest = n;
    }
    EXPECT_EQ(nearest_name(name, candidates), nearest) << name;
  }
}

// The work grows with the length and not with its square: that would be 10¹² letters compared.
TEST(NearestName, OfAMillionLettersIsFound) {
  const std::string name(1'000'000, 'a');
  std::string slip = name, other = name;
  slip[500'000] = 'b';
  for (std::size_t k = 0; k < other.size(); k += 2) other[k] = 'c';
  EXPECT_EQ(nearest_name(slip, {other, name}), name);
  EXPECT_EQ(nearest_name(slip, {other}), std::nullopt);
}

TEST(Suggest, NamesTheNearestOrListsTheKnown) {
  EXPECT_EQ(suggest("gian", {"gain", "bandwidth"}), "did you mean 'gain'?");
  EXPECT_EQ(suggest("colour", {"gain", "bandwidth"}), "known: gain, bandwidth");
  EXPECT_EQ(suggest("colour", {}), "");
}

TEST(Suggest, ListsFirstWhatHoldsTheWordWhereTheListIsCut) {
  std::vector<std::string> names = {"gain", "servo-amplifier", "noise", "servo-resolver"};
  EXPECT_EQ(suggest("servo", names), "known: gain, servo-amplifier, noise, servo-resolver");
  names.resize(13, "x");
  EXPECT_THAT(suggest("servo", names),
              ::testing::StartsWith("known: servo-amplifier, servo-resolver, gain, noise, x"));
}

TEST(Suggest, KeepsALongListShort) {
  std::vector<std::string> names;
  for (int i = 0; i < 15; ++i) names.push_back("block" + std::to_string(i));
  EXPECT_EQ(suggest("zzzzzzzzz", names),
            "known: block0, block1, block2, block3, block4, block5, block6, block7, block8, block9, block10, "
            "block11 "
            "and 3 more");
}

// A host that is no command line: what it is told are names, and it spells them.
TEST(Remedy, IsSpelledByWhoeverSpeaksToTheReader) {
  const Vocabulary buttons{
      [](const Setting& setting) { return "[" + setting.name + "|" + setting.value + "]"; },
      [](const Action& action) { return "<" + action.name + "|" + action.subject + ">"; }};
  Remedy remedy{"end it with ", Setting{"until"}, " or ", Setting{"gain", "1e4"}};
  remedy += {"; ", Action{"check", "a.toml"}, " tells why"};
  EXPECT_EQ(remedy.words(), "end it with 'until' or gain 1e4; 'check a.toml' tells why");
  EXPECT_EQ(remedy.words(buttons), "end it with [until|] or [gain|1e4]; <check|a.toml> tells why");
  EXPECT_TRUE(Remedy().empty());
  EXPECT_TRUE(Remedy("").empty());
  EXPECT_FALSE(remedy.empty());
}

TEST(Diagnostic, OfASettingNamesItBehindTheFile) {
  const Diagnostic of_file{{"m.toml", {}, {"split", "AB,CD"}}, "no triad has these legs", {}, {}};
  EXPECT_EQ(to_string(of_file), "m.toml: split AB,CD: no triad has these legs");
  const Diagnostic of_none{{{}, {}, {"columns"}}, "20 curves cannot be told apart", "at most 18", {}};
  EXPECT_EQ(to_string(of_none), "'columns': 20 curves cannot be told apart; expected at most 18");
}

}  // namespace
}  // namespace oblique::text
