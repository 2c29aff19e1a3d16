// SPDX-License-Identifier: MIT
// The table of agreement, and what it says of the programmes that are shipped.
#include <oblique/report/atlas/agreement.h>

#include <fstream>
#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/text/file.h>

#include "../../support/compiled.h"
#include "../../support/scratch_folder.h"

namespace oblique::report {
namespace {

using ::testing::ElementsAre;
using testing::message_of;

// 0.5 of what was published is met, 2 is explained, 2.5 is neither.
constexpr const char* kThree = R"toml(format = "oblique-diagram/1"
[blocks]
one = { type = "constant", value = 1 }
[outputs]
x = { signal = "one", unit = "m" }
[published]
author = "A"
title = "T"
[[published.value]]
name = "x"
value = 1.05
within = 0.1
[[published.value]]
name = "x"
value = 102
within = 1
unit = "cm"
because = "it was read twice"
[[published.value]]
name = "x"
label = "the third"
value = 0.75
within = 0.1
)toml";

Programme programme(const std::string& text, const std::string& file = "three.toml") {
  return run_programme(file, text, testing::shipped_blocks());
}

TEST(Agreement, IsATableOfDifferencesOverUncertainties) {
  const std::vector<Programme> programmes{programme(kThree)};
  EXPECT_THAT(
      agreement_table(programmes).rows(),
      ElementsAre(ElementsAre("programme", "value", "published", "±", "unit", "computed", "difference/±", ""),
                  ElementsAre("three", "x at end", "1.05", "0.1", "m", "1", "0.5", ""),
                  ElementsAre("three", "x at end", "102", "1", "cm", "100", "2", "explained"),
                  ElementsAre("three", "the third", "0.75", "0.1", "m", "1", "2.5", "DIFFERS")));
  EXPECT_FALSE(all_known(programmes));
}

TEST(Agreement, NamesNoUnitOfWhatHasNone) {
  const Table table = agreement_table({programme(R"toml(format = "oblique-diagram/1"
[blocks]
one = { type = "constant", value = 1 }
[outputs]
n = { signal = "one", unit = "1" }
[published]
author = "A"
title = "T"
[[published.value]]
name = "n"
value = 1
within = 0.1
)toml")});
  ASSERT_EQ(table.rows().size(), 2U);
  EXPECT_EQ(table.rows()[1][4], "");
}

TEST(Agreement, CountsWhatAgrees) {
  const std::string head =
      "format = \"oblique-diagram/1\"\n[blocks]\none = { type = \"constant\" }\n[published]\nauthor = "
      "\"A\"\ntitle = \"T\"\n";
  EXPECT_EQ(
      agreement_summary({programme(kThree), programme(head + "picture = \"a line\"\n"),
                         programme(head + "kind = \"equations\"\n")}),
      "3 programmes, 3 published values: 1 within their uncertainty, 1 beyond it and "
      "explained, 1 unexplained; 1 programme held against a picture alone; 1 programme without a published "
      "result");
  EXPECT_TRUE(all_known({programme(head + "kind = \"equations\"\n")}));
}

class ProgrammeFolder : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  test::ScratchFolder folder_;
};

TEST_F(ProgrammeFolder, HasThoseThatWerePublished) {
  write("b.toml", kThree);
  write("sub/a.toml", kThree);
  write("own.toml", "format = \"oblique-diagram/1\"\n[blocks]\n");
  write("m.toml", "format = \"oblique-mechanism/1\"\n");
  write("notes.txt", "format");
  EXPECT_THAT(programmes_in(folder_.path()), ElementsAre(folder_ / "b.toml", folder_ / "sub/a.toml"));
  write("sub/b.toml", kThree);
  EXPECT_EQ(message_of<text::ReadError>([&] { programmes_in(folder_.path()); }),
            (folder_ / "sub/b.toml").string() + ": this programme is called as that of " +
                (folder_ / "b.toml").string() + "; expected another name of the file");
}

TEST_F(ProgrammeFolder, IsRefusedWhereThereIsNone) {
  EXPECT_EQ(
      message_of<text::ReadError>([&] { programmes_in(folder_.path()); }),
      folder_.path().string() +
          ": no diagram in this folder says where it was published; expected diagrams with [published]");
  EXPECT_EQ(message_of<text::ReadError>([&] { programmes_in(folder_ / "none"); }),
            (folder_ / "none").string() + ": cannot read the folder: No such file or directory");
}

// The table that the atlas stands for; each file that differs says why.
TEST(Atlas, AgreesWithWhatWasPublished) {
  std::vector<Programme> programmes;
  for (const auto& file : programmes_in(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/atlas"))
    programmes.push_back(run_programme(file, text::read_file(file), testing::shipped_blocks()));
  std::cout << agreement_table(programmes).text(2) << agreement_summary(programmes) << "\n";
  EXPECT_TRUE(all_known(programmes));
}

}  // namespace
}  // namespace oblique::report
