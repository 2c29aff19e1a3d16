// SPDX-License-Identifier: MIT
// The pictures of the README and of the course are what the program draws.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

struct ShownPicture {
  const char* name;
  const char* page;     ///< that shows it
  const char* command;  ///< without the name of the picture, which stands at its end
};

void PrintTo(const ShownPicture& picture, std::ostream* out) {
  *out << picture.name;
}

class Readme : public ::testing::TestWithParam<ShownPicture> {};
INSTANTIATE_TEST_SUITE_P(
    Pictures, Readme,
    ::testing::Values(
        ShownPicture{
            "walking-leg.svg", "README.md",
            "oblique animate diagrams/mechanisms/jansen.toml --magnify 500 --gain 1e4 --frames 36 -o"},
        ShownPicture{"triangle-side.svg", "README.md", "oblique draw diagrams/lessons/triangle-side.toml -o"},
        ShownPicture{"course-1-open-amplifier.svg", "docs/course/1-open-amplifier.md",
                     "oblique draw diagrams/course/1-open-amplifier.toml -o"},
        ShownPicture{"course-1-curves.svg", "docs/course/1-open-amplifier.md",
                     "oblique run diagrams/course/1-open-amplifier.toml --plot"},
        ShownPicture{"course-2-loop.svg", "docs/course/2-loop.md",
                     "oblique draw diagrams/course/2-loop.toml -o"},
        ShownPicture{"course-3-sign.svg", "docs/course/3-sign.md",
                     "oblique draw diagrams/course/3-sign.toml -o"},
        ShownPicture{"course-3-curves.svg", "docs/course/3-sign.md",
                     "oblique run diagrams/course/3-sign.toml --vary y.initial=-0.51,-0.49,0,0.9 --columns y "
                     "--plot"},
        ShownPicture{"course-4-two-equations.svg", "docs/course/4-two-equations.md",
                     "oblique draw diagrams/course/4-two-equations.toml -o"},
        ShownPicture{"course-5-triangle.svg", "docs/course/5-triangle.md",
                     "oblique draw diagrams/course/5-triangle.toml -o"},
        ShownPicture{"course-6-four-bar.svg", "docs/course/6-four-bar.md",
                     "oblique draw diagrams/course/6-four-bar-mechanism.toml --at '60 deg' -o"},
        ShownPicture{"course-7-class-three.svg", "docs/course/7-class-three.md",
                     "oblique draw diagrams/course/7-class-three-mechanism.toml -o"},
        ShownPicture{"course-8-trust.svg", "docs/course/8-trust.md",
                     "oblique run diagrams/course/8-trust.toml --vary c.bandwidth=0.1,1,10 --columns error "
                     "--plot"}));

/// What stands between the numbers of a text, and the numbers.
struct Tokens {
  std::string words;
  std::vector<double> numbers;
};

Tokens tokens_of(const std::string& text) {
  static const std::regex kNumber(R"(-?\d+(\.\d+)?)");
  Tokens tokens;
  auto rest = text.begin();
  for (std::sregex_iterator at(text.begin(), text.end(), kNumber), end; at != end; ++at) {
    tokens.words.append(rest, text.begin() + at->position()) += '#';
    tokens.numbers.push_back(std::stod(at->str()));
    rest = text.begin() + at->position() + at->length();
  }
  tokens.words.append(rest, text.end());
  return tokens;
}

TEST_P(Readme, ShowsWhatTheProgramDraws) {
  const ScratchFolder folder;
  const std::filesystem::path drawn = folder / "picture.svg";
  const std::string command = GetParam().command;
  const Outcome outcome = run_command(command + " " + drawn.string(), OBLIQUE_SOURCE_DIR);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Tokens now = tokens_of(text_of(drawn));
  const std::string shipped = std::string("docs/pictures/") + GetParam().name;
  const Tokens then = tokens_of(text_of(std::string(OBLIQUE_SOURCE_DIR) + "/" + shipped));
  const std::string remedy = "renew it: " + command + " " + shipped;
  ASSERT_TRUE(now.words == then.words) << remedy;
  ASSERT_EQ(now.numbers.size(), then.numbers.size()) << remedy;
  // A solver's last digits differ between compilers: 1e-10 of the links, 500 times as large, are less than a
  // thousandth of a pixel, and the numbers are rounded to a hundredth.
  for (std::size_t k = 0; k < now.numbers.size(); ++k)
    ASSERT_NEAR(now.numbers[k], then.numbers[k], 0.0101) << remedy;
}

// The README before its first commands, a page of the course anywhere.
TEST_P(Readme, IsShownByItsPage) {
  const std::string page = GetParam().page;
  const std::string text = text_of(std::string(OBLIQUE_SOURCE_DIR) + "/" + page);
  if (page == "README.md") {
    EXPECT_THAT(text.substr(0, text.find("```")),
                HasSubstr(std::string("](docs/pictures/") + GetParam().name));
  } else {
    EXPECT_THAT(text, HasSubstr(std::string("](../pictures/") + GetParam().name));
  }
}

}  // namespace
}  // namespace oblique::test
