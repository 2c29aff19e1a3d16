// SPDX-License-Identifier: MIT
#include <oblique/text/csv.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique {
namespace {

using ::testing::ElementsAre;

std::string refusal(std::string_view text) {
  try {
    parse_csv(text, "d.csv");
  } catch (const ReadError& error) {
    return error.what();
  }
  return "";
}

TEST(Csv, ReadsColumnsByName) {
  const CsvTable table =
      parse_csv("# made by hand\r\n\"t\", \"u, v\" ,w\r\n0,1e-3,-2\r\n\r\n0.5, 4 ,5\r\n", "d.csv");
  EXPECT_THAT(table.names, ElementsAre("t", "u, v", "w"));
  EXPECT_THAT(*table.find("t"), ElementsAre(0, 0.5));
  EXPECT_THAT(*table.find("u, v"), ElementsAre(1e-3, 4));
  EXPECT_EQ(table.find("x"), nullptr);
}

TEST(Csv, NamesTheCellThatIsNoNumber) {
  EXPECT_EQ(refusal("t,u\n0,1\n1,two\n"), "d.csv:3:3: 'two' is no number; expected a number in every cell");
  EXPECT_EQ(refusal("t,u\n0\n"), "d.csv:2:1: the line has 1 cells; expected 2, as the line of names has");
  EXPECT_EQ(refusal("t,u\n0,\n"), "d.csv:2:3: '' is no number; expected a number in every cell");
  EXPECT_EQ(refusal("\n"), "d.csv:1:1: the file is empty; expected a line of names, then lines of numbers");
}

}  // namespace
}  // namespace oblique
