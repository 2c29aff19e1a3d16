// SPDX-License-Identifier: MIT
#include <oblique/text/csv.h>

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::text {
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

/// One table with t = 0, 0.5 and u = −1.5, 2, as different hands write it.
struct Hand {
  const char* name;
  std::string_view text;
};
const std::array kHands{
    Hand{"CommasAndPoints", "t,u\n0,-1.5\n0.5,2\n"},
    Hand{"ByteOrderMark", "\xEF\xBB\xBFt,u\r\n0,-1.5\r\n0.5,2\r\n"},
    Hand{"SemicolonsAndDecimalCommas", "t [s]; u [V]\n0; -1,5\n0,5; 2\n"},
    Hand{"Tabs", "t\tu\n0\t-1.5\n0.5\t2\n"},
    Hand{"Spaces", "# a plotter's file\nt [s]   u [V]\n0.0    -1.5\n0.5   2e0\n"},
    Hand{"QuotedDecimalCommas", "\"t\",\"u\"\n\"0\",\"-1,5\"\n\"0,5\",\"2\"\n"},
    Hand{"SeparatorOfASpreadsheet", "sep=;\nt;u\n0;-1.5\n0.5;2\n"},
    Hand{"OpenEnds", "t;u;\n0;-1.5;\n0.5;2;\n"},
    Hand{"LineOfUnits", "t;u\ns;V\n0;-1.5\n0.5;2\n"},
    Hand{"LineOfUnitsInBrackets", "t,u\n[s],(V)\n0,-1.5\n0.5,2\n"},
    Hand{"NamesInAComment", "# t,u\n0,-1.5\n0.5,2\n"},
    Hand{"TypesetMinus", "t,u\n0,\u22121.5\n0.5,+2\n"},
    Hand{"OldMac", "t,u\r0,-1.5\r0.5,2\r"},
    Hand{"EndOfADosFile", "t,u\r\n0,-1.5\r\n0.5,2\r\n\x1a"},
    Hand{"SlashUnits", "t/s,u/mV\n0,-1.5\n0.5,2\n"},
};

class CsvByHand : public ::testing::TestWithParam<Hand> {};
INSTANTIATE_TEST_SUITE_P(Csv, CsvByHand, ::testing::ValuesIn(kHands),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(CsvByHand, IsTheSameTable) {
  const CsvTable table = parse_csv(GetParam().text, "d.csv");
  ASSERT_NE(table.find("t"), nullptr);
  ASSERT_NE(table.find("u"), nullptr);
  EXPECT_THAT(*table.find("t"), ElementsAre(0, 0.5));
  EXPECT_THAT(*table.find("u"), ElementsAre(-1.5, 2));
}

TEST(Csv, NumbersColumnsThatHaveNoNames) {
  const CsvTable table = parse_csv("0;0,5\n1;2\n", "d.csv");
  EXPECT_THAT(table.names, ElementsAre("1", "2"));
  EXPECT_THAT(*table.find("2"), ElementsAre(0.5, 2));
}

// Whether spaces part the columns the line below the names tells, and no later one; a file may end with
// either.
TEST(Csv, LooksAtTheNextLineForSpaces) {
  EXPECT_THAT(parse_csv("time of day\n1 2 3\n", "d.csv").names, ElementsAre("time", "of", "day"));
  EXPECT_EQ(refusal("time of day\n1\n2 3 4\n"),
            "d.csv:3:1: '2 3 4' is no number; expected a number in every cell");
  EXPECT_THAT(parse_csv("time of day\n", "d.csv").names, ElementsAre("time of day"));
  EXPECT_THAT(parse_csv("1 2\n", "d.csv").names, ElementsAre("1", "2"));
  EXPECT_THAT(parse_csv("# t u\n1 2\n", "d.csv").names, ElementsAre("t", "u"));
}

TEST(Csv, TakesLatin1) {
  const CsvTable table = parse_csv("phi [\xB0],u\n0,1\n", "d.csv");
  EXPECT_THAT(table.names, ElementsAre("phi [°]", "u"));
}

TEST(Csv, RefusesWhatMayMeanTwoNumbers) {
  EXPECT_EQ(refusal("t;u\n0;1.234,5\n"),
            "d.csv:2:3: '1.234,5' leaves open whether the point or the comma begins the decimals; expected "
            "one of the "
            "two in the numbers of a file\n  remedy: write thousands without marks between them");
  EXPECT_THAT(refusal("t;u\n0,5;1\n1;1.234\n"), ::testing::StartsWith("d.csv:3:3: '1.234' leaves open"));
  EXPECT_EQ(refusal("t,u\n0,5,1,5\n"),
            "d.csv:2:1: the line has 4 cells; expected 2, as the line of names has\n"
            "  remedy: numbers with decimal commas stand in quotes, or between semicolons or tabs");
  EXPECT_EQ(refusal("t,u\n0,0.5 V\n"), "d.csv:2:3: '0.5 V' is no number; expected a number in every cell");
  EXPECT_EQ(refusal("t,u\n0,--1\n"), "d.csv:2:3: '--1' is no number; expected a number in every cell");
  EXPECT_EQ(refusal("\xFF\xFEt\0"),
            "d.csv:1:1: the file is in UTF-16; expected text in UTF-8\n"
            "  remedy: save it anew and choose UTF-8 as its encoding");
}

TEST(Csv, TellsNamesFromUnits) {
  const auto parts = [](std::string_view text) {
    const CsvHeading heading = split_heading(text);
    return heading.name + "|" + heading.unit;
  };
  EXPECT_EQ(parts("t [ms]"), "t|ms");
  EXPECT_EQ(parts("speed (rad/s)"), "speed|rad/s");
  EXPECT_EQ(parts("u/mV"), "u|mV");
  EXPECT_EQ(parts("w/(rad/s)"), "w|rad/s");
  EXPECT_EQ(parts("U in V"), "U|V");
  EXPECT_EQ(parts("t, s"), "t|s");
  EXPECT_EQ(parts("a/b"), "a/b|");
  EXPECT_EQ(parts("P5.x"), "P5.x|");
}

TEST(Csv, DoesNotGuessBetweenTwoColumns) {
  const CsvTable table = parse_csv("u [V],u [mV]\n1,2\n", "d.csv");
  EXPECT_EQ(table.find("u"), nullptr);
  EXPECT_THAT(*table.find("u [mV]"), ElementsAre(2));
}

}  // namespace
}  // namespace oblique::text
