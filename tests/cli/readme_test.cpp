// SPDX-License-Identifier: MIT
// The pictures with which the README opens are what the program draws.
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

struct ReadmePicture {
  const char* name;
  const char* command;  ///< without -o
};

void PrintTo(const ReadmePicture& picture, std::ostream* out) {
  *out << picture.name;
}

class Readme : public ::testing::TestWithParam<ReadmePicture> {};
INSTANTIATE_TEST_SUITE_P(
    Pictures, Readme,
    ::testing::Values(
        ReadmePicture{"walking-leg.svg",
                      "oblique animate diagrams/mechanisms/jansen.toml --magnify 500 --gain 1e4 --frames 36"},
        ReadmePicture{"triangle-side.svg", "oblique draw diagrams/lessons/triangle-side.toml"}));

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
  const Outcome outcome = run_command(command + " -o " + drawn.string(), OBLIQUE_SOURCE_DIR);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Tokens now = tokens_of(text_of(drawn));
  const std::string shipped = std::string("docs/pictures/") + GetParam().name;
  const Tokens then = tokens_of(text_of(std::string(OBLIQUE_SOURCE_DIR) + "/" + shipped));
  const std::string remedy = "renew it: " + command + " -o " + shipped;
  ASSERT_TRUE(now.words == then.words) << remedy;
  ASSERT_EQ(now.numbers.size(), then.numbers.size()) << remedy;
  // A solver's last digits differ between compilers: 1e-10 of the links, 500 times as large, are less than a
  // thousandth of a pixel, and the numbers are rounded to a hundredth.
  for (std::size_t k = 0; k < now.numbers.size(); ++k)
    ASSERT_NEAR(now.numbers[k], then.numbers[k], 0.0101) << remedy;
}

TEST_P(Readme, OpensWithIt) {
  const std::string readme = text_of(std::string(OBLIQUE_SOURCE_DIR) + "/README.md");
  EXPECT_THAT(readme.substr(0, readme.find("```")),
              HasSubstr(std::string("](docs/pictures/") + GetParam().name));
}

}  // namespace
}  // namespace oblique::test
