// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/identity.h>

#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/scratch_folder.h"

namespace oblique::ensemble {
namespace {

using ::testing::HasSubstr;

Plan some_plan() {
  Plan plan;
  plan.subject = "x.toml";
  plan.vary = {{"x.initial", "1,2", {}}};
  plan.measures = {{"x", "end(x)", {}}};
  return plan;
}

constexpr const char* kText = "format = \"oblique-diagram/1\"\n";

TEST(Identity, ChangesWithAllThatTheNumbersDependOn) {
  const Identity base = identity_of(some_plan(), kText, {}, "1");
  EXPECT_EQ(identity_of(some_plan(), kText, {}, "1"), base);
  EXPECT_NE(identity_of(some_plan(), kText, {}, "2").version, base.version);
  EXPECT_NE(identity_of(some_plan(), "format = \"oblique-diagram/1\" # another\n", {}, "1").subject,
            base.subject);
  const auto changes = [&](auto&& change) {
    Plan plan = some_plan();
    change(plan);
    return identity_of(plan, kText, {}, "1").plan != base.plan;
  };
  EXPECT_TRUE(changes([](Plan& plan) { plan.seed = 2; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.runs = 2; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.sampling = Sampling::sobol; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.vary[0].values = "1,3"; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.scatter = {{"multiplier", "error", 0.1, {}}}; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.tolerance_of_elements = 0.1; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.machine = "tr-10"; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.measures[0].expression = "max(x)"; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.tolerance = 1e-9; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.samples = 11; }));
  EXPECT_TRUE(changes([](Plan& plan) { plan.mechanism = true; }));
  // Where the files lie makes no difference: the same plan on another computer.
  EXPECT_FALSE(changes([](Plan& plan) { plan.subject = "/elsewhere/y.toml"; }));
  EXPECT_FALSE(changes([](Plan& plan) { plan.file = "elsewhere.toml"; }));
}

TEST(Identity, KnowsTheFilesThatASubjectReads) {
  const test::ScratchFolder folder;
  Plan plan = some_plan();
  plan.subject = (folder / "x.toml").string();
  const std::string text =
      std::string(kText) +
      "[blocks]\nu = { type = \"function\", points = { file = \"u.csv\", x = \"t\", y = \"u\" } }\n";
  std::ofstream(folder / "u.csv") << "t,u\n0,0\n1,1\n";
  const Identity before = identity_of(plan, text, {}, "1");
  EXPECT_EQ(identity_of(plan, text, {}, "1"), before);
  std::ofstream(folder / "u.csv") << "t,u\n0,0\n1,2\n";
  EXPECT_NE(identity_of(plan, text, {}, "1").subject, before.subject);
}

TEST(Identity, KnowsFurtherBlocks) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "own.toml") << "format = \"oblique-block/1\"\n";
  const Identity none = identity_of(some_plan(), kText, {}, "1");
  const Identity one = identity_of(some_plan(), kText, {folder.path()}, "1");
  EXPECT_NE(one.blocks, none.blocks);
  std::ofstream(folder / "own.toml") << "format = \"oblique-block/1\"\ntitle = \"Own\"\n";
  EXPECT_NE(identity_of(some_plan(), kText, {folder.path()}, "1").blocks, one.blocks);
}

TEST(ChunkPlace, CutsTheRunsWithoutGapOrOverlap) {
  for (const std::uint64_t runs :
       {std::uint64_t{1}, std::uint64_t{7}, std::uint64_t{1000}, std::uint64_t{1} << 53U}) {
    for (const std::uint64_t chunks : {1U, 2U, 3U, 7U, 1000U}) {
      if (chunks > runs) continue;
      std::uint64_t next = 0, least = runs, most = 0;
      for (std::uint64_t k = 0; k < chunks; ++k) {
        const ChunkPlace place = chunk_place(k, chunks, runs);
        EXPECT_EQ(place.first, next);
        next += place.count;
        least = std::min(least, place.count);
        most = std::max(most, place.count);
      }
      EXPECT_EQ(next, runs);
      EXPECT_LE(most - least, 1U);
    }
  }
}

TEST(ChunkPlace, CountsFromZeroOrFromOne) {
  EXPECT_EQ(parse_chunk_place("4/4", 100).first, 0U);
  EXPECT_EQ(parse_chunk_place("0/4", 100).first, 0U);
  EXPECT_EQ(parse_chunk_place("3/4", 100).first, 75U);
  EXPECT_EQ(parse_chunk_place("1/1", 100).count, 100U);
  EXPECT_EQ(name_of(parse_chunk_place("4/4", 100)), "0/4 (that is 4/4)");
  EXPECT_EQ(name_of(parse_chunk_place("3/4", 100)), "3/4");
}

std::string finding_of(const std::string& text, std::uint64_t runs) {
  try {
    parse_chunk_place(text, runs);
  } catch (const PlanError& error) {
    return error.what();
  }
  return "none";
}

TEST(ChunkPlace, RefusesWhatIsNone) {
  EXPECT_EQ(finding_of("5/4", 100),
            "'chunk': there is no chunk 5 of 4; expected a number from 0 to 3, or from 1 to 4");
  EXPECT_EQ(finding_of("1/3", 2),
            "'chunk': an ensemble of 2 runs is not cut into 3 chunks; expected from 1 to 2 chunks");
  EXPECT_EQ(finding_of("1/0", 1),
            "'chunk': an ensemble of 1 run is not cut into 0 chunks; expected from 1 to 1 chunks");
  for (const char* text : {"", "1", "1/", "/2", "-1/2", "1/2x", "1 / 2", "1/99999999999999999999", "a/b"})
    EXPECT_EQ(finding_of(text, 10),
              "'chunk': '" + std::string(text) +
                  "' is no part of an ensemble; expected i/n, the i-th of n chunks, such as 3/16");
}

TEST(ChunkPlace, GivesEachFileItsOwnName) {
  const Identity identity{"1", "plan", "subject", "blocks"};
  std::set<std::string> names;
  for (std::uint64_t k = 0; k < 4; ++k) names.insert(file_name_of(identity, chunk_place(k, 4, 100)));
  names.insert(file_name_of(identity, chunk_place(0, 5, 100)));
  names.insert(file_name_of(identity, chunk_place(0, 4, 104)));
  for (const Identity& other :
       {Identity{"2", "plan", "subject", "blocks"}, Identity{"1", "p", "subject", "blocks"},
        Identity{"1", "plan", "s", "blocks"}, Identity{"1", "plan", "subject", "b"}})
    names.insert(file_name_of(other, chunk_place(0, 4, 100)));
  EXPECT_EQ(names.size(), 10U);
  EXPECT_THAT(*names.begin(), HasSubstr("0-of-4-"));
}

}  // namespace
}  // namespace oblique::ensemble
