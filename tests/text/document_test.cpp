// SPDX-License-Identifier: MIT
#include <oblique/text/document.h>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::text {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

using ValueKind = Value::Kind;

std::string document_message(std::string_view text) {
  try {
    parse_document(text, "test.toml");
  } catch (const ReadError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Document, KeepsKindsAndValues) {
  const Document document = parse_document(R"(
flag = true
whole = 42
real = -1.5
text = "φ̇"
list = [1, "two", [3]]
day = 1969-07-20
[table]
key = 0x10
)",
                                           "test.toml");
  const Value& root = document.root;
  EXPECT_EQ(document.file, "test.toml");
  EXPECT_EQ(root.position, (SourcePosition{1, 1}));
  EXPECT_TRUE(root.find("flag")->boolean);
  EXPECT_EQ(root.find("whole")->number, 42);
  EXPECT_EQ(root.find("real")->number, -1.5);
  EXPECT_EQ(root.find("text")->text, "φ̇");
  EXPECT_EQ(root.find("list")->elements.size(), 3U);
  EXPECT_EQ(root.find("list")->elements[1].text, "two");
  EXPECT_EQ(root.find("list")->elements[2].elements[0].number, 3);
  EXPECT_EQ(root.find("day")->kind, ValueKind::date);
  EXPECT_EQ(root.find("table")->find("key")->number, 16);
  EXPECT_EQ(root.find("nothing"), nullptr);
}

TEST(Document, KeepsTheOrderOfTheFile) {
  const Document document = parse_document("zebra = 1\nant = 2\n[mouse]\n[bear]\n", "test.toml");
  std::vector<std::string> keys;
  for (const Entry& entry : document.root.entries) keys.push_back(entry.key);
  EXPECT_THAT(keys, ::testing::ElementsAre("zebra", "ant", "mouse", "bear"));
}

TEST(Document, KnowsWhereKeysAndValuesStand) {
  const Document document = parse_document("# Ω\n[a]\n  key   = { \"Ω\" = [10, 20] }\n[b.c]\n", "test.toml");
  const Entry& a = document.root.entries[0];
  EXPECT_EQ(a.position, (SourcePosition{2, 2}));
  EXPECT_EQ(a.value.position, (SourcePosition{2, 1}));
  const Entry& key = a.value.entries[0];
  EXPECT_EQ(key.position, (SourcePosition{3, 3}));
  EXPECT_EQ(key.value.position, (SourcePosition{3, 11}));
  const Entry& inner = key.value.entries[0];
  EXPECT_EQ(inner.position, (SourcePosition{3, 13}));
  EXPECT_EQ(inner.value.elements[1].position, (SourcePosition{3, 24}))
      << "columns count characters, not bytes";
  EXPECT_EQ(document.root.find("b")->find("c")->position, (SourcePosition{4, 1}));
}

TEST(Document, TakesAnEmptyFileAndAByteOrderMark) {
  EXPECT_TRUE(parse_document("", "test.toml").root.entries.empty());
  EXPECT_TRUE(parse_document("# nothing\n", "test.toml").root.entries.empty());
  EXPECT_EQ(parse_document("\xEF\xBB\xBF"
                           "a = 1",
                           "test.toml")
                .root.find("a")
                ->number,
            1);
}

TEST(Document, ReadsNotANumberAndInfinityAsTomlHasThem) {
  const Document document = parse_document("a = nan\nb = -inf\n", "test.toml");
  EXPECT_TRUE(std::isnan(document.root.find("a")->number));
  EXPECT_EQ(document.root.find("b")->number, -std::numeric_limits<double>::infinity());
}

TEST(Document, NamesEveryKind) {
  EXPECT_EQ(kind_name(ValueKind::boolean), "true or false");
  EXPECT_EQ(kind_name(ValueKind::number), "a number");
  EXPECT_EQ(kind_name(ValueKind::string), "a string");
  EXPECT_EQ(kind_name(ValueKind::array), "an array");
  EXPECT_EQ(kind_name(ValueKind::table), "a table");
  EXPECT_EQ(kind_name(ValueKind::date), "a date");
}

// The wording after "broken TOML:" is toml++'s own; the place and the rest are ours.
TEST(DocumentMessages, GiveThePlaceAndHowToWriteIt) {
  EXPECT_EQ(document_message("a = 1\nspeed = 100 rad/s\n"),
            "test.toml:2:13: broken TOML: parsing key-value pair: expected a comment or whitespace, saw 'r'\n"
            "  remedy: words, and numbers with a unit, stand in quotes (\"60 rpm\"); the syntax is at "
            "https://toml.io/en/v1.0.0");
  EXPECT_THAT(document_message("type = summer\n"), StartsWith("test.toml:1:8: broken TOML: parsing value: "));
  EXPECT_THAT(document_message("a = 1\na = 2\n"),
              StartsWith("test.toml:2:5: broken TOML: parsing key-value pair: cannot redefine"));
  EXPECT_THAT(document_message("a = \"\xFF\"\n"),
              AllOf(StartsWith("test.toml:1:5: broken TOML: Encountered invalid utf-8 sequence"),
                    HasSubstr("remedy: save the file anew and choose UTF-8 as its encoding")));
  EXPECT_THAT(document_message("a = 1e400"),
              StartsWith("test.toml:1:10: broken TOML: parsing floating-point: '1e400'"));
  EXPECT_THAT(document_message("a = 99999999999999999999"), HasSubstr("is not representable in 64 bits"));
}

// The assertions of toml++ 3.3 that malformed text breaks: each is a message with its place, in every
// build type.
TEST(DocumentMessages, GiveThePlaceWhereTheParserWouldAssert) {
  EXPECT_THAT(document_message("[&"),
              StartsWith("test.toml:1:2: broken TOML: parsing key: expected bare key"));
  EXPECT_THAT(document_message("[φ]\n"),
              HasSubstr("1:2: broken TOML: parsing key: expected bare key starting character or string "
                        "delimiter, saw 'φ'"));
  EXPECT_THAT(document_message("a = [}"),
              StartsWith("test.toml:1:6: broken TOML: parsing value: could not determine"));
  EXPECT_THAT(document_message("a = 1984-07-20Tq20:17:40Z"),
              StartsWith("test.toml:1:16: broken TOML: parsing time: expected 2-digit hour"));
  // Longer than the parser can step back, in a function that is noexcept.
  EXPECT_THAT(document_message("a = 2020" + std::string(116, '_') + "-01-01 00000"),
              StartsWith("test.toml:1:5: broken TOML: "));
  EXPECT_THAT(document_message("a = 2020-01-01" + std::string(116, '_') + " 0" + std::string(200, '0')),
              StartsWith("test.toml:1:"));
}

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

// Each text would overflow the stack by far, were it parsed or freed without a limit.
TEST(DeepDocument, IsRefusedAndNotACrash) {
  const std::string values = "broken TOML: parsing value: exceeded maximum nested value depth of 32";
  const std::string keys = "a key has more than 20 parts\n  remedy: shorten it";
  EXPECT_THAT(document_message("a = " + repeated("[", 200'000)), HasSubstr("test.toml:1:37: " + values));
  EXPECT_THAT(document_message("a = " + repeated("{a = ", 200'000)), HasSubstr(values));
  EXPECT_EQ(document_message("x = 1.5 # a\n a" + repeated(".a", 200'000) + " = 1"),
            "test.toml:2:41: " + keys);
  EXPECT_THAT(document_message("[\"]\"" + repeated(" . 'a'", 200'000) + "]"), HasSubstr(keys));
  EXPECT_THAT(document_message("[[a" + repeated(".a", 200'000) + "]]"), HasSubstr(keys));
}

TEST(DeepDocument, DotsElsewhereAreNoNesting) {
  const std::string dots = repeated("a.", 100);
  EXPECT_EQ(document_message("# " + dots + "\na = \"" + dots + "\\\"" + dots + "\" # " + dots), "no error");
  EXPECT_EQ(document_message("a = '" + dots + "'\nb = \"\"\"\n" + dots + "\"\"\"\"\" # \"" + dots + "\n"),
            "no error");
  EXPECT_EQ(document_message("a = [" + repeated("1.5, ", 1000) + "]"), "no error");
  EXPECT_EQ(document_message("a" + repeated(".a", 19) + " = 1"), "no error");
  EXPECT_EQ(document_message("a = " + repeated("[", 31) + repeated("]", 31)), "no error");
}

TEST(Document, TakesAByteOrderMarkAndTypesetSigns) {
  const Document document = parse_document(
      "\xEF\xBB\xBF[t]\r\na = \u22121.5\r\nb =\u00a0\u20132 # \u2212\r\nc = \"\u2212x\"\r\n", "t.toml");
  const Value& table = *document.root.find("t");
  EXPECT_EQ(table.find("a")->number, -1.5);
  EXPECT_EQ(table.find("b")->number, -2);
  EXPECT_EQ(table.find("c")->text, "\u2212x");
  EXPECT_EQ(table.find("c")->position, (SourcePosition{4, 5}));
}

TEST(DocumentMessages, HaveTheRemedyOfWhatTheParserFinds) {
  const auto remedy = [](std::string_view text) {
    const std::string message = document_message(text);
    return message.substr(std::min(message.find("  remedy: "), message.size()));
  };
  const auto twice = [](const std::string& name) {
    return "  remedy: " + name + " stands here a second time: rename one of the two, or leave one out";
  };
  EXPECT_EQ(remedy("[blocks]\nx = { a = 1 }\nx = { a = 2 }\n"), twice("'x'"));
  EXPECT_EQ(remedy("[run]\na = 1\n[run]\nb = 1\n"), twice("'run'"));
  EXPECT_EQ(remedy("[b.x]\na = 1\n[b.x]\na = 2\n"), twice("'b.x'"));
  EXPECT_EQ(remedy("run = 1\n[run]\n"), twice("'run'"));
  EXPECT_EQ(remedy("x = { a = 1, a = 2 }\n"), twice("'a'"));
  EXPECT_EQ(remedy("x = 1\nx.a = 2\n"), twice("a name"));
  EXPECT_EQ(remedy("x = { a = 1 }\n[x.b]\n"), twice("'x.b'"));
  EXPECT_EQ(remedy("a = 1e400\n"), "  remedy: numbers go up to 1.8e308: write a smaller one, or inf");
  EXPECT_EQ(remedy("a = 99999999999999999999\n"),
            "  remedy: write a number as long as this with a point: 1e20 or 1.0");
  EXPECT_EQ(remedy("a = 1\r[b]\r"),
            "  remedy: save the file anew and choose line ends of Unix (LF) or Windows (CR LF)");
}

TEST(Document, SaysWhatIsOpenOrOutOfPlace) {
  EXPECT_THAT(document_message("a = { x = 1"),
              HasSubstr("close the quote, bracket or brace that is open there"));
  EXPECT_THAT(document_message("a = \"abc\nb = 1\n"), HasSubstr("close the quote on its own line"));
  EXPECT_THAT(document_message(std::string("a = 1\0\n", 7)), HasSubstr("take the control character out"));
  EXPECT_THAT(document_message("a = " + std::string(600, '[')), HasSubstr("put fewer brackets or braces"));
}

TEST(Document, SaysWhatIsTypesetAndWhereACommaIsNoPoint) {
  EXPECT_THAT(document_message("a = 1\nb = \u201cx\u201d\n"), HasSubstr("the quotes here are typeset"));
  EXPECT_THAT(document_message("a = { x = 0,5 }\n"),
              HasSubstr("remedy: numbers have a decimal point, not a comma: write 0.5"));
  EXPECT_THAT(document_message("a = -141,25e-3\n"), HasSubstr("not a comma: write 141.25e-3"));
  EXPECT_THAT(document_message("a = [0,5, x]\n"),
              HasSubstr("words, and numbers with a unit, stand in quotes"));
  EXPECT_THAT(document_message("\xFE\xFFx"), HasSubstr("the file is in UTF-16"));
}

}  // namespace
}  // namespace oblique::text
