// SPDX-License-Identifier: MIT
// What the program says of itself, and that the examples in it run.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "verbs.h"

namespace oblique::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// The words at the beginnings of the indented lines behind "Commands:".
std::vector<std::string> verbs_of(const std::string& help) {
  std::vector<std::string> verbs;
  std::istringstream lines(help.substr(help.find("\nCommands:\n") + 11));
  for (std::string line; std::getline(lines, line) && line.starts_with("  ");) {
    std::istringstream words(line);
    words >> verbs.emplace_back();
  }
  return verbs;
}

TEST_F(Verbs, EachTellsHowItIsCalledInWords) {
  const std::vector<std::string> verbs = verbs_of(oblique("--help").out);
  ASSERT_GE(verbs.size(), 17U);
  for (const std::string& verb : verbs) {
    const Outcome help = oblique(verb + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("Usage: oblique " + verb));
    EXPECT_THAT(help.out, Not(ContainsRegex("TEXT|UINT|INT in|REQUIRED|Needs:|Excludes:|NONNEGATIVE")));
    EXPECT_EQ(oblique("help " + verb).out, help.out);
  }
  EXPECT_EQ(oblique("help").out, oblique("--help").out);
  EXPECT_THAT(oblique("draw --help").out,
              AllOf(HasSubstr("--positions N"),
                    HasSubstr("one over the other (1 to 1000; default 1; not with --plots)\n"),
                    HasSubstr("(default 1e6; with --magnify)\n")));
}

TEST_F(Verbs, EachHasAnExampleThatRuns) {
  std::filesystem::create_directory_symlink(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams", file("diagrams"));
  std::ofstream(file("path.csv")) << "F.x,F.y\n60,70\n65,75\n70,70\n";
  for (const std::string& verb : verbs_of(oblique("--help").out)) {
    // An ensemble is shown on its page; the studio must be built first, which test.studio does.
    if (verb == "ensemble" || verb == "studio" || verb == "atlas") continue;
    const std::string help = oblique(verb + " --help").out;
    const std::string mark = "\nFor example: ";
    const std::size_t at = help.find(mark);
    ASSERT_NE(at, std::string::npos) << verb;
    const std::string example = help.substr(at + mark.size(), help.find('\n', at + 1) - at - mark.size());
    const Outcome outcome = run_command(example + " </dev/null", file(""));
    EXPECT_EQ(outcome.status, 0) << example << "\n" << outcome.err;
  }
}

}  // namespace
}  // namespace oblique::test
