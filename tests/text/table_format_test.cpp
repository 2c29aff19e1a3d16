// SPDX-License-Identifier: MIT
// What each format of tables writes, to the byte where another program reads it.
#include <cstdint>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <oblique/text/csv.h>

#include "table_reading.h"

namespace oblique::text {
namespace {

using test::Folder;
using test::kInfinity;
using test::kNan;
using test::named;
using test::read_mat;
using test::read_npy;
using test::written;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(CsvFile, HasALineOfNamesAndALineARow) {
  EXPECT_EQ(written(".csv", {{"t", "s"}, {"C.x", "mm"}}, {0.0, 1.5, 0.1, -2e-300}),
            "t,C.x\n0,1.5\n0.1,-2e-300\n");
}

TEST(CsvFile, QuotesNamesAsRfc4180Says) {
  EXPECT_EQ(written(".csv", named({"a,b", "say \"x\"", "two\nlines", "plain name"}), {}),
            "\"a,b\",\"say \"\"x\"\"\",\"two\nlines\",plain name\n");
}

// What begins so a spreadsheet computes, and it may compute anything.
TEST(CsvFile, HoldsNoFormulaAndNoControlCharacter) {
  EXPECT_EQ(written(".csv", named({"=1+1", "+a", "-a", "@a", "\ta", "a=1"}), {}),
            "'=1+1,'+a,'-a,'@a,'\ta,a=1\n");
  EXPECT_EQ(written(".csv", named({"\x1b[2J", std::string("n\0l", 3), "a\rb"}), {}), "␛[2J,n␀l,a␍b\n");
}

TEST(CsvFile, LeavesCellsEmptyAndWritesWords) {
  EXPECT_EQ(written(".csv", {{"x"}, {"status", "", {"ok", "dead-centre", "open"}}},
                    {1, 0, 2, 1, kNan, 2, kNan, kNan, 3, 7, 4, 0.5, 5, -1}),
            "x,status\n1,ok\n2,dead-centre\n,open\n,\n3,7\n4,0.5\n5,-1\n");
}

TEST(CsvFile, IsReadByOurOwnReader) {
  const CsvTable table = parse_csv(written(".csv", named({"t", "P.x"}), {0.1, 1e300, 0.2, -5e-324}), "t.csv");
  EXPECT_THAT(table.names, ElementsAre("t", "P.x"));
  EXPECT_THAT(table.columns[1], ElementsAre(1e300, -5e-324));
}

TEST(JsonFile, NamesColumnsWithUnitsAndThenRows) {
  EXPECT_EQ(written(".json", {{"t", "s"}, {"a\"\\\n", "mm"}, {"status", "", {"ok", "open"}}},
                    {0, 1.5, 0, -0.0, kNan, 1}),
            "{\"columns\": [{\"name\": \"t\", \"unit\": \"s\"}, {\"name\": \"a\\\"\\\\\\u000a\", \"unit\": "
            "\"mm\"}, {\"name\": \"status\", \"unit\": \"\"}],\n"
            "\"rows\": [\n[0, 1.5, \"ok\"],\n[-0.0, null, \"open\"]\n]}\n");
  EXPECT_EQ(nlohmann::json::parse(written(".json", named({"a\tb\"c"}), {}))["columns"][0]["name"], "a\tb\"c");
  EXPECT_EQ(nlohmann::json::parse(written(".json", named({"φ"}), {}))["columns"][0]["name"], "φ");
}

// The first 80 bytes of what numpy.save wrote for a table of these two fields and three rows (NumPy 1.24).
TEST(NpyFile, BeginsAsNumPyItselfWritesIt) {
  const std::string bytes = written(".npy", named({"t", "P5.x"}), {0, 1, 2, 3, 4, 5});
  const std::string header =
      "{'descr': [('t', '<f8'), ('P5.x', '<f8')], 'fortran_order': False, 'shape': (3,), }";
  EXPECT_EQ(bytes.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  EXPECT_EQ(bytes.substr(10, 0x76), header + std::string(0x76 - 1 - header.size(), ' ') + "\n");
  EXPECT_EQ(bytes.size(), 128U + 6 * 8);
}

TEST(NpyFile, KeepsAnyNameAndTellsEqualOnesApart) {
  const std::string bytes = written(".npy", named({"it's", "a\\b", "tab\t", "x", "x", "x_1", "class"}), {});
  EXPECT_EQ(bytes.at(6), 1);
  EXPECT_THAT(read_npy(bytes).names, ElementsAre("it's", "a\\b", "tab\t", "x", "x_1", "x_1_1", "class"));
}

TEST(NpyFile, TakesANewerVersionForOtherLettersAndManyColumns) {
  const std::string greek = written(".npy", named({"φ", "t"}), {1, 2});
  EXPECT_EQ(greek.at(6), 3);
  EXPECT_THAT(read_npy(greek).names, ElementsAre("φ", "t"));
  std::vector<std::string> names;
  for (int k = 0; k < 5000; ++k) names.push_back("column" + std::to_string(k));
  const std::string wide = written(".npy", named(names), std::vector<double>(5000, 1.5));
  EXPECT_EQ(wide.at(6), 2);
  EXPECT_EQ(read_npy(wide).names, names);
}

TEST(MatFile, HasTheBytesOfTheFormat) {
  using namespace std::string_literals;
  const std::string header = "\0\0\0\0\x02\0\0\0\x01\0\0\0\0\0\0\0"s;
  EXPECT_EQ(written(".mat", named({"t", "P.x"}), {1, -2, 0.5, kInfinity}),
            header + "\x02\0\0\0t\0"s + "\0\0\0\0\0\0\xF0\x3F\0\0\0\0\0\0\xE0\x3F"s + header +
                "\x04\0\0\0P_x\0"s + "\0\0\0\0\0\0\0\xC0\0\0\0\0\0\0\xF0\x7F"s);
}

TEST(MatFile, NamesVariablesAsMatlabAllows) {
  const auto names = [](const std::vector<std::string>& all) {
    return read_mat(written(".mat", named(all), {})).names;
  };
  EXPECT_THAT(names({"P5.x", "x0A9z", "end", "2nd", "_a", "until", "φ̇", "", "a b"}),
              ElementsAre("P5_x", "x0A9z", "xEnd", "x2nd", "x_a", "xUntil", "x__", "x", "a_b"));
  EXPECT_THAT(names({"P.x", "P_x", "P:x", "P_x_1"}), ElementsAre("P_x_2", "P_x", "P_x_3", "P_x_1"))
      << "good names stay";
  const std::string sixty(60, 'a');
  EXPECT_THAT(names({sixty + ".bcd", sixty + ".bce", sixty + "_bc"}),
              ElementsAre(sixty + "__1", sixty + "__2", sixty + "_bc"));
}

TEST(MatFile, SaysThatItCanHoldNoMore) {
  const Folder folder;
  EXPECT_THAT([&] { TableFile(folder / "a.mat", named({"t"}), 3'000'000'000); },
              ::testing::ThrowsMessage<ReadError>(
                  "the table is too long for a .mat file; expected 2147483647 rows at most\n  remedy: write "
                  ".npy"));
  EXPECT_THAT(folder.files(), IsEmpty());
}

}  // namespace
}  // namespace oblique::text
