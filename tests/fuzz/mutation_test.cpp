// SPDX-License-Identifier: MIT
// The fuzz targets on mutations of our own files with a fixed seed: short, and the same in every run.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <oblique/text/document.h>
#include <oblique/text/file.h>

#include "targets.h"

namespace oblique::fuzz {
namespace {

std::vector<std::string> texts_below(const std::vector<std::string>& folders) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(OBLIQUE_SOURCE_DIR "/" + folder)) {
      if (entry.is_regular_file() && entry.path().extension() != ".txt") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const std::filesystem::path& path : paths) texts.push_back(text::read_file(path));
  return texts;
}

/// Changes a text in one to four places: flips, drops, doubles, inserts, or splices in a piece of another
/// text.
std::string mutate(std::string text, const std::vector<std::string>& others, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return n == 0 ? 0 : random() % n;  // the standard distributions differ between libraries
  };
  using namespace std::string_literals;
  static const std::string special = "[]{}=,.\"'#\\\n\r\t +-*/^()_09eE\0\x7F\xC3\xFF"s;
  for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(below(20), text.size() - at);
    switch (below(5)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.insert(at, 1, special[below(special.size())]);
        break;
      default: {
        const std::string& other = others[below(others.size())];
        const std::size_t from = below(other.size() + 1);
        text.insert(at, other.substr(from, below(40)));
      }
    }
  }
  return text;
}

void run_mutations(const std::function<void(std::string_view)>& target, const std::vector<std::string>& texts,
                   int count) {
  ASSERT_FALSE(texts.empty());
  for (const std::string& text : texts) target(text);
  std::mt19937 random(20240229);
  for (int i = 0; i < count; ++i) {
    const std::string& text = texts[random() % texts.size()];
    target(mutate(text, texts, random));
  }
}

// A broken promise or an escaping exception ends the process, which is how these fail.
TEST(Mutations, OfDocumentsAreReadOrRefused) {
  run_mutations(document, texts_below({"blocks", "tests/fuzz/corpus/document"}), 2000);
}

TEST(Mutations, OfExpressionsAreReadOrRefused) {
  run_mutations(expression, texts_below({"tests/fuzz/corpus/expression"}), 15'000);
}

}  // namespace
}  // namespace oblique::fuzz
