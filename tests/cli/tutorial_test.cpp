// SPDX-License-Identifier: MIT
// Runs every command of the documentation and holds what it prints against what the page says it prints.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

/// A console block of a page: a command behind "$ " and the lines it prints. A line "…" stands for any lines,
/// and "…" at the end of one for the rest of it.
struct Example {
  std::string page;
  int line = 0;
  std::string command;
  std::vector<std::string> expected;
};

std::vector<Example> examples_of(const std::string& page) {
  std::ifstream stream(std::string(OBLIQUE_SOURCE_DIR) + "/" + page);
  std::vector<Example> examples;
  bool console = false;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.starts_with("```")) {
      console = line == "```console";
    } else if (console && line.starts_with("$ ")) {
      examples.push_back({page, number, line.substr(2), {}});
    } else if (console && !examples.empty()) {
      examples.back().expected.push_back(line);
    }
  }
  return examples;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Numbers may differ in what depends on the compiler's rounding: by 2 %, or by the size of a solver's
/// tolerance.
bool same_word(const std::string& a, const std::string& b) {
  if (a == b) return true;
  char* end_a = nullptr;
  char* end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  if (end_a == a.c_str() || end_b == b.c_str() || std::string(end_a) != end_b) return false;
  return std::abs(x - y) <= 0.02 * std::max(std::abs(x), std::abs(y)) + 1e-9;
}

/// Words that tell time or work ("ms", "steps") and so differ from machine to machine, by their place from
/// the end.
bool same_line(const std::string& a, const std::string& b, const std::vector<std::size_t>& ignored) {
  auto left = words_of(a), right = words_of(b);
  if (!left.empty() && left.back() == "…") {
    left.pop_back();
    right.resize(std::min(left.size(), right.size()));
  }
  if (left.size() != right.size()) return false;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const bool ignore = std::find(ignored.begin(), ignored.end(), left.size() - i) != ignored.end();
    if (!ignore && !same_word(left[i], right[i])) return false;
  }
  return true;
}

std::vector<std::size_t> places_from_the_end(const std::string& header) {
  const auto words = words_of(header);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "ms" || words[i] == "steps") places.push_back(words.size() - i);
  }
  return places;
}

void expect_output(const Example& example, const std::string& printed) {
  std::vector<std::string> lines;
  std::istringstream stream(printed);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::vector<std::size_t> ignored;
  std::size_t at = 0;
  bool anything = false;
  for (const std::string& expected : example.expected) {
    if (expected == "…") {
      anything = true;
      continue;
    }
    if (words_of(expected).empty()) continue;
    const std::vector<std::size_t> places = places_from_the_end(expected);
    const std::string first = words_of(expected)[0];
    if (!places.empty() && (first == "gain" || first == "method")) ignored = places;
    while (at < lines.size() &&
           (words_of(lines[at]).empty() || (anything && !same_line(expected, lines[at], ignored))))
      ++at;
    ASSERT_LT(at, lines.size()) << "missing: " << expected << "\nprinted:\n" << printed;
    EXPECT_TRUE(same_line(expected, lines[at], ignored))
        << "page:    " << expected << "\nprinted: " << lines[at];
    ++at;
    anything = false;
  }
}

/// The pages with console examples, all of the course among them.
std::vector<std::string> pages() {
  std::vector<std::string> names = {"docs/tutorial.md",
                                    "docs/running.md",
                                    "docs/operating.md",
                                    "docs/blocks.md",
                                    "docs/check.md",
                                    "docs/machines.md",
                                    "docs/patching-a-machine.md",
                                    "docs/mechanisms.md",
                                    "docs/drawing.md",
                                    "docs/synthesis.md",
                                    "docs/trust.md",
                                    "docs/sweeps.md",
                                    "README.md"};
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/docs/course"))
    names.push_back("docs/course/" + entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

class Page : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Docs, Page, ::testing::ValuesIn(pages()), [](const auto& tested) {
  const std::filesystem::path page = tested.param;
  std::string name = page.stem().string();
  if (page.parent_path().filename() == "course") name = "course_" + name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// The commands of a page run in order, in a copy of the diagrams, since some write files that later ones
// read.
TEST_P(Page, PrintsWhatItSays) {
  const ScratchFolder folder;
  std::filesystem::copy(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams", folder / "diagrams",
                        std::filesystem::copy_options::recursive);
  const std::vector<Example> examples = examples_of(GetParam());
  EXPECT_FALSE(examples.empty());
  for (const Example& example : examples) {
    if (example.command.starts_with("./bootstrap")) continue;  // CI itself is that example
    SCOPED_TRACE(example.page + ":" + std::to_string(example.line) + ": " + example.command);
    const Outcome outcome = run_command(example.command + " 2>&1", folder.path().string());
    expect_output(example, outcome.out);
    EXPECT_TRUE(outcome.status == 0 || outcome.out.find("error:") != std::string::npos ||
                outcome.out.find("FAILED") != std::string::npos ||
                outcome.out.find("wrong   question:") != std::string::npos ||
                outcome.out.find("the run ends there") != std::string::npos ||
                outcome.out.find("is not written") != std::string::npos ||
                example.command.starts_with("diff "))
        << outcome.out;
  }
}

}  // namespace
}  // namespace oblique::test
