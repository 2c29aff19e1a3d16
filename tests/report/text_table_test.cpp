// SPDX-License-Identifier: MIT
#include <oblique/report/text_table.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::report {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(TextTable, AlignsByCharactersAndEndsLinesWithoutBlanks) {
  Table table({"name", "φ", ""});
  table.add({"ä", "1", ""});
  table.add({"long name", "-20", "!"});
  EXPECT_EQ(table.text(1), "name         φ\nä            1\nlong name  -20  !\n");
  EXPECT_EQ(table.text(), "     name    φ\n        ä    1\nlong name  -20  !\n");
}

TEST(TextTable, SpreadsRowsFromTheFirstToTheLast) {
  EXPECT_THAT(spread_rows(101, 3), ElementsAre(0, 50, 100));
  EXPECT_THAT(spread_rows(2, 9), ElementsAre(0, 1));
  EXPECT_THAT(spread_rows(5, 1), ElementsAre(0));
  EXPECT_THAT(spread_rows(0, 9), IsEmpty());
}

TEST(TextTable, ShowsRoundingBesideLargeNumbersAsZero) {
  EXPECT_EQ(short_number(1.0 / 3), "0.333333");
  EXPECT_EQ(short_number(-0.0), "0");
  EXPECT_EQ(short_number(1e-16), "1e-16");
  EXPECT_EQ(short_number(-1e-16, 1), "0");
  EXPECT_EQ(short_number(std::nan("")), "");
}

TEST(TextTable, CountsInWords) {
  EXPECT_EQ(count(1, "block", "blocks"), "1 block");
  EXPECT_EQ(count(0, "block", "blocks"), "0 blocks");
}

}  // namespace
}  // namespace oblique::report
