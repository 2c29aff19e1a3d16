// SPDX-License-Identifier: MIT
#include <oblique/diagram/block_library.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <future>
#include <map>
#include <regex>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/flatten.h>
#include <oblique/text/file.h>

#include "../support/scratch_folder.h"
#include "small_library.h"

namespace oblique::diagram {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;

const std::filesystem::path kBlocks = std::filesystem::path(OBLIQUE_SOURCE_DIR) / "blocks";

/// An empty directory that goes with the test.
class Directory {
 public:
  void write(const std::string& name, const std::string& text) const {
    text::write_file(folder_ / name, text);
  }
  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  test::ScratchFolder folder_;
};

std::string block_text(const std::string& title) {
  return "format = \"oblique-block/1\"\ntitle = \"" + title + "\"\n[outputs]\ny = {}\n[equations]\ny = 1\n";
}

TEST(BlockLibrary, ShipsExactlyTheFilesOfTheDirectory) {
  std::vector<std::string> stems;
  for (const auto& file : std::filesystem::directory_iterator(kBlocks)) {
    if (file.path().extension() == ".toml") stems.push_back(file.path().stem().string());
  }
  std::sort(stems.begin(), stems.end());
  EXPECT_EQ(BlockLibrary::shipped().names(), stems)
      << "blocks/CMakeLists.txt must list every file of blocks/";
}

TEST(BlockLibrary, ShipsTheFilesAsTheyStand) {
  const BlockLibrary library = BlockLibrary::shipped();
  for (const std::string& name : library.names()) {
    const BlockDefinition* const block = library.find(name);
    ASSERT_NE(block, nullptr);
    EXPECT_EQ(block->text, text::read_file(kBlocks / (name + ".toml"))) << name;
    EXPECT_EQ(block->file, "blocks/" + name + ".toml");
    EXPECT_FALSE(block->title.empty()) << name;
    EXPECT_FALSE(block->summary.empty()) << name;
    EXPECT_FALSE(block->symbol.empty()) << name;
  }
}

/// Every input of every shipped block wired to a constant, which checks the wiring inside the composites too.
TEST(BlockLibrary, ShipsBlocksThatFlatten) {
  const BlockLibrary library = BlockLibrary::shipped();
  for (const std::string& name : library.names()) {
    Diagram diagram;
    diagram.blocks.resize(2);
    diagram.blocks[0].name = "one";
    diagram.blocks[0].type = "constant";
    diagram.blocks[1].name = "tested";
    diagram.blocks[1].type = name;
    for (const InputPort& input : library.find(name)->inputs) {
      diagram.blocks[1].settings.push_back(text_setting(input.name, "one"));
    }
    EXPECT_EQ(message_of([&] { flatten(diagram, library); }), "") << name;
  }
}

/// Against the texts of the files, where a role stands in a line of its own.
TEST(BlockLibrary, FindsTheBlockOfARole) {
  const BlockLibrary library = BlockLibrary::shipped();
  std::map<std::string, std::string> names;  // of the blocks, by their roles
  for (const std::string& name : library.names()) {
    std::smatch found;
    const std::string text = text::read_file(kBlocks / (name + ".toml"));
    if (std::regex_search(text, found, std::regex("\nrole *= \"([a-z-]+)\"\n"))) names[found[1]] = name;
  }
  EXPECT_EQ(names.size(), 11U);
  for (int role = static_cast<int>(Role::reference); role <= static_cast<int>(Role::function_generator);
       ++role) {
    const BlockDefinition* const block = BlockLibrary::shipped().find(static_cast<Role>(role));
    ASSERT_NE(block, nullptr) << role;
    EXPECT_EQ(block->name, names[std::string(role_name(static_cast<Role>(role)))]);
  }
}

TEST(BlockLibrary, ParsesAShippedFileOnceForAllWhoAskAtOnce) {
  std::array<std::future<const BlockDefinition*>, 4> found;
  for (auto& one : found)
    one = std::async(std::launch::async, [] { return BlockLibrary::shipped().find("dyad-rrr"); });
  const BlockDefinition* const first = found[0].get();
  EXPECT_EQ(first->name, "dyad-rrr");
  for (auto& one : std::span(found).subspan(1)) EXPECT_EQ(one.get(), first);
}

TEST(BlockLibrary, ReadsADirectoryAndReplacesBlocks) {
  const Directory directory;
  directory.write("mine.toml", block_text("Mine"));
  directory.write("summer.toml", block_text("My summer"));
  directory.write("notes.txt", "not a block");
  BlockLibrary library = BlockLibrary::shipped();
  const std::size_t shipped = library.names().size();
  library.add_directory(directory.path());
  EXPECT_EQ(library.names().size(), shipped + 1);
  EXPECT_EQ(library.find("mine")->title, "Mine");
  EXPECT_EQ(library.find("summer")->title, "My summer");
  EXPECT_EQ(library.find("mine")->file, (directory.path() / "mine.toml").string());
  EXPECT_EQ(library.find("yours"), nullptr);
}

TEST(BlockLibrary, NamesAreInAlphabeticalOrder) {
  EXPECT_THAT(testing::small_library().names(),
              ElementsAre("adder", "cosine-of", "product", "reference", "resolver", "servo"));
}

TEST(BlockLibrary, ReportsAllFilesOfADirectoryTogether) {
  const Directory directory;
  directory.write("a.toml", "[broken");
  directory.write("b.toml", block_text("B") + "z = \"nix\"\n");
  directory.write("c d.toml", block_text("C"));
  BlockLibrary library;
  const std::string message = message_of([&] { library.add_directory(directory.path()); });
  EXPECT_THAT(message, HasSubstr("a.toml:1:"));
  EXPECT_THAT(message, HasSubstr("b.toml:7:6: equation 'z': there is no name 'nix'"));
  EXPECT_THAT(
      message,
      HasSubstr("c d.toml: 'c d' cannot be the name of a block type; expected a file name of letters, "
                "digits, '_' and '-'"));
}

TEST(BlockLibrary, SaysWhereThereIsNoDirectory) {
  BlockLibrary library;
  EXPECT_EQ(message_of([&] { library.add_directory("no/such/place"); }),
            "no/such/place: cannot read the blocks here: No such file or directory; expected a directory "
            "with block files");
}

}  // namespace
}  // namespace oblique::diagram
