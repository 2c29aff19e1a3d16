// SPDX-License-Identifier: MIT
// Every shipped block is documented, and some test or diagram uses it.
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <oblique/text/document.h>
#include <oblique/text/file.h>

#include "../support/compiled.h"

namespace oblique::test {
namespace {

using testing::shipped_blocks;

TEST(ShippedBlocks, AreDocumented) {
  for (const std::string& name : shipped_blocks().names()) {
    const diagram::BlockDefinition& block = *shipped_blocks().find(name);
    EXPECT_FALSE(block.title.empty()) << name;
    EXPECT_FALSE(block.summary.empty()) << name;
    EXPECT_TRUE(block.summary.ends_with('.')) << name << ": the summary is a sentence";
    EXPECT_FALSE(block.doc.empty()) << name;
    EXPECT_NE(block.doc.find('='), std::string::npos) << name << ": the doc has no formula";
    EXPECT_FALSE(block.symbol.empty()) << name;
    for (const diagram::InputPort& input : block.inputs)
      EXPECT_FALSE(input.doc.empty()) << name << '.' << input.name;
    for (const diagram::OutputPort& output : block.outputs)
      EXPECT_FALSE(output.doc.empty()) << name << '.' << output.name;
    for (const diagram::ParameterDefinition& p : block.parameters)
      EXPECT_FALSE(p.doc.empty()) << name << '.' << p.name;
  }
}

TEST(ShippedBlocks, AreEachUsedByATestOrADiagram) {
  // type = "name", with its quotes escaped in a plain string of C++.
  const std::regex use(R"re(type = \\?"([a-z0-9-]+)\\?")re");
  std::set<std::string> used;
  for (const char* const folder : {"tests", "diagrams"}) {
    const auto root = std::filesystem::path(OBLIQUE_SOURCE_DIR) / folder;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      const auto extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".h" && extension != ".toml") continue;
      const std::string text = text::read_file(entry.path());
      for (std::sregex_iterator found(text.begin(), text.end(), use), end; found != end; ++found)
        used.insert((*found)[1]);
    }
  }
  for (const std::string& name : shipped_blocks().names()) {
    EXPECT_TRUE(used.contains(name)) << "no test and no diagram uses '" << name << "'";
  }
}

}  // namespace
}  // namespace oblique::test
