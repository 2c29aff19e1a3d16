// SPDX-License-Identifier: MIT
#include <oblique/text/table_reader.h>

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::text {
namespace {

using ::testing::ElementsAre;

/// Reads a text with a TableReader named "[run]" and keeps what it found.
class TableReaderTest : public ::testing::Test {
 protected:
  TableReader& read(std::string_view text) {
    document_ = parse_document(text, "t.toml");
    return reader_.emplace("t.toml", document_.root, "[run]", diagnostics_);
  }

  std::string findings() {
    try {
      diagnostics_.throw_if_any<ReadError>();
    } catch (const ReadError& error) {
      return error.what();
    }
    return "";
  }

  Document document_;
  Diagnostics diagnostics_;
  std::optional<TableReader> reader_;
};

TEST_F(TableReaderTest, GivesTypedValues) {
  TableReader& reader =
      read("s = \"x\"\nb = true\nq = \"60 rpm\"\nn = 2\nt = {}\nl = [\"a\", \"b\"]\none = \"c\"\n");
  EXPECT_EQ(reader.string("s"), "x");
  EXPECT_EQ(reader.boolean("b"), true);
  EXPECT_DOUBLE_EQ(reader.quantity("q", "rev/min").value(), 60);
  EXPECT_EQ(reader.quantity("n", "m"), 2);
  EXPECT_NE(reader.table("t"), nullptr);
  EXPECT_THAT(reader.strings("l").value(), ElementsAre("a", "b"));
  EXPECT_THAT(reader.strings("one", true).value(), ElementsAre("c"));
  EXPECT_EQ(reader.what(), "[run]");
  EXPECT_EQ(&reader.table(), &document_.root);
  reader.finish();
  EXPECT_EQ(findings(), "");
}

TEST_F(TableReaderTest, GivesNothingForAbsentKeys) {
  TableReader& reader = read("");
  EXPECT_EQ(reader.find("a"), nullptr);
  EXPECT_EQ(reader.string("a"), std::nullopt);
  EXPECT_EQ(reader.boolean("a"), std::nullopt);
  EXPECT_EQ(reader.quantity("a", "m"), std::nullopt);
  EXPECT_EQ(reader.table("a"), nullptr);
  EXPECT_EQ(reader.strings("a"), std::nullopt);
  EXPECT_EQ(findings(), "");
}

TEST_F(TableReaderTest, ReportsTheWrongKindAtTheValue) {
  TableReader& reader = read("s = 1\nb = \"no\"\nq = true\nt = [1]\nl = \"a\"\nm = [1]\n");
  EXPECT_EQ(reader.string("s"), std::nullopt);
  EXPECT_EQ(reader.boolean("b"), std::nullopt);
  EXPECT_EQ(reader.quantity("q", "m"), std::nullopt);
  EXPECT_EQ(reader.table("t"), nullptr);
  EXPECT_EQ(reader.strings("l"), std::nullopt);
  EXPECT_EQ(reader.strings("m", true), std::nullopt);
  EXPECT_EQ(findings(),
            "t.toml:1:5: 's' of [run] is a number; expected a string\n"
            "t.toml:2:5: 'b' of [run] is a string; expected true or false\n"
            "t.toml:3:5: 'q' of [run] is true or false; expected a number or a quantity in 'm'\n"
            "t.toml:4:5: 't' of [run] is an array; expected a table\n"
            "t.toml:5:5: 'l' of [run] is not a list of names; expected [\"name\", …]\n"
            "t.toml:6:5: 'm' of [run] is not a list of names; expected \"name\" or [\"name\", …]");
}

TEST_F(TableReaderTest, ReportsRequiredKeysThatAreAbsent) {
  TableReader& reader = read("");
  EXPECT_EQ(reader.required_string("title", "a title"), std::nullopt);
  EXPECT_EQ(reader.required_quantity("length", "mm"), std::nullopt);
  EXPECT_EQ(findings(),
            "t.toml:1:1: [run] has no 'title'; expected a title\n"
            "t.toml:1:1: [run] has no 'length'; expected a quantity in 'mm'");
}

TEST_F(TableReaderTest, ReportsARequiredKeyOfTheWrongKindOnce) {
  TableReader& reader = read("title = 1\nlength = \"x\"\n");
  reader.required_string("title", "a title");
  reader.required_quantity("length", "mm");
  EXPECT_EQ(findings(),
            "t.toml:1:9: 'title' of [run] is a number; expected a string\n"
            "t.toml:2:11: 'length' of [run]: 'x' is not a known constant; expected a number, 'pi' or 'inf'");
}

TEST_F(TableReaderTest, ReportsUnknownKeysWithTheNearestKnown) {
  TableReader& reader = read("untill = 1\ncolour = 2\nuntil = 3\n");
  reader.quantity("until", "s");
  reader.quantity("until", "s");
  reader.quantity("tolerance", "1");
  reader.finish();
  EXPECT_EQ(findings(),
            "t.toml:1:1: unknown key 'untill' in [run]\n  remedy: did you mean 'until'?\n"
            "t.toml:2:1: unknown key 'colour' in [run]\n  remedy: known: until, tolerance");
}

TEST_F(TableReaderTest, ReportsAValueThatIsNoTableAndNothingMore) {
  document_ = parse_document("run = 5\n", "t.toml");
  TableReader reader("t.toml", *document_.root.find("run"), "[run]", diagnostics_);
  EXPECT_EQ(reader.required_string("title", "a title"), std::nullopt);
  EXPECT_EQ(reader.required_quantity("length", "mm"), std::nullopt);
  EXPECT_EQ(reader.table("a"), nullptr);
  EXPECT_EQ(reader.strings("b"), std::nullopt);
  reader.finish();
  EXPECT_EQ(findings(), "t.toml:1:7: [run] is a number; expected a table");
}

TEST_F(TableReaderTest, TakesInfinityAndRefusesNotANumber) {
  TableReader& reader = read("a = inf\nb = \"-inf\"\nc = nan\nd = \"sqrt(-1)\"\n");
  EXPECT_EQ(reader.quantity("a", "1"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(reader.quantity("b", "1"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(reader.quantity("c", "1"), std::nullopt);
  EXPECT_EQ(reader.quantity("d", "1"), std::nullopt);
  EXPECT_EQ(findings(),
            "t.toml:3:5: 'c' of [run] has no value (not a number); expected a number\n"
            "t.toml:4:5: 'd' of [run] has no value (not a number); expected a number");
}

TEST_F(TableReaderTest, AsksTheLookupForNames) {
  const NameLookup lookup = [](std::string_view) { return std::optional(4.0); };
  EXPECT_EQ(read("a = \"r/2\"\n").quantity("a", "1", lookup), 2);
}

TEST_F(TableReaderTest, PointsIntoTheTextOfAString) {
  TableReader& reader =
      read("a = \"2*gain\"\nb = \"5 φφ furlong\"\nc = '3 mm'\nd = \"\"\"\n1 +\n gain\"\"\"\n");
  reader.quantity("a", "1");
  reader.quantity("b", "m");
  reader.quantity("c", "s");
  reader.quantity("d", "1");
  EXPECT_EQ(findings(),
            "t.toml:1:8: 'a' of [run]: 'gain' is not a known constant; expected a number, 'pi' or 'inf'\n"
            "t.toml:2:8: 'b' of [run]: there is no unit 'φφ furlong'; expected a quantity in 'm'\n"
            "  remedy: known: m, dm, cm, mm, um, µm, μm, km, in, ft\n"
            "t.toml:3:8: 'c' of [run]: 'mm' is the wrong unit here; expected a quantity in 's'\n"
            "  remedy: give it in 's', or as a number without a unit\n"
            "t.toml:4:5: 'd' of [run]: 'gain' is not a known constant; expected a number, 'pi' or 'inf'");
}

TEST(ToDiagnostic, CountsCharactersAndNotBytes) {
  Value value;
  value.kind = Value::Kind::string;
  value.position = {3, 10};
  value.text = "φφ+x";  // five bytes stand before the x
  const Diagnostic diagnostic = to_diagnostic({6, "what", "expected", "remedy"}, "t.toml", value, "'a'");
  EXPECT_EQ(to_string(diagnostic), "t.toml:3:14: 'a': what; expected expected\n  remedy: remedy");
}

TEST_F(TableReaderTest, ReportsAtTheValueOrAtTheTable) {
  TableReader& reader = read("a = 1\nb = 2\n");
  reader.report("b", "finding", "this", "do that");
  reader.report("c", "absent");
  EXPECT_EQ(findings(), "t.toml:1:1: absent\nt.toml:2:5: finding; expected this\n  remedy: do that");
  EXPECT_EQ(reader.place({7, 8}), (Place{"t.toml", {7, 8}}));
}

TEST_F(TableReaderTest, ReadsAnExpectedValue) {
  const auto expected =
      read_expected_value(read("value = \"3 mm\"\nwithin = 0.5\n"), parse_unit("m").value());
  ASSERT_TRUE(expected);
  EXPECT_EQ(expected->value, 0.003);
  EXPECT_EQ(expected->within, 0.5);
  EXPECT_EQ(findings(), "");
}

TEST_F(TableReaderTest, ChecksAnExpectedValue) {
  EXPECT_FALSE(read_expected_value(read("withn = 1\n")));
  EXPECT_EQ(findings(),
            "t.toml:1:1: [run] has no 'value'; expected a quantity in '1'\n"
            "t.toml:1:1: [run] has no 'within'; expected a quantity in '1'\n"
            "t.toml:1:1: unknown key 'withn' in [run]\n  remedy: did you mean 'within'?");
}

TEST_F(TableReaderTest, TakesOnlyFiniteExpectedValues) {
  read_expected_value(read("value = inf\nwithin = inf\n"));
  EXPECT_EQ(findings(),
            "t.toml:1:9: 'value' of [run] is infinite; expected a finite number\n"
            "t.toml:2:10: 'within' of [run] is inf; expected a finite number above 0");
}

TEST_F(TableReaderTest, TakesOnlyTolerancesAboveZero) {
  read_expected_value(read("value = 1\nwithin = 0\n"));
  EXPECT_EQ(findings(), "t.toml:2:10: 'within' of [run] is 0; expected a finite number above 0");
}

TEST_F(TableReaderTest, ChecksTheFormat) {
  EXPECT_TRUE(check_format(read("format = \"oblique-diagram/1\"\n"), "oblique-diagram/1"));
  EXPECT_EQ(findings(), "");
  EXPECT_TRUE(check_format(read("format = \"oblique-diagram/2\"\n"), "oblique-diagram/1"));
  EXPECT_EQ(
      findings(),
      "t.toml:1:10: the format is 'oblique-diagram/2'; expected 'oblique-diagram/1'\n"
      "  remedy: a diagram is oblique-diagram/1, a mechanism oblique-mechanism/1, a block oblique-block/1");
}

TEST_F(TableReaderTest, TellsWhatAFileOfAnotherKindIsFor) {
  EXPECT_FALSE(check_format(read("format = \"oblique-mechanism/1\"\n"), "oblique-diagram/1"));
  EXPECT_EQ(findings(),
            "t.toml:1:10: the format is 'oblique-mechanism/1'; expected 'oblique-diagram/1'\n"
            "  remedy: this is a mechanism: 'solve', 'compare' and 'draw' take it, 'patch' makes a diagram "
            "of it");
}

TEST_F(TableReaderTest, MissesTheFormat) {
  EXPECT_TRUE(check_format(read(""), "oblique-block/1"));
  EXPECT_EQ(findings(), "t.toml:1:1: [run] has no 'format'; expected format = \"oblique-block/1\"");
}

}  // namespace
}  // namespace oblique::text
