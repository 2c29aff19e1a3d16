// SPDX-License-Identifier: MIT
#include <oblique/text/toml_layout.h>

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace oblique::text {
namespace {

std::string words(const TomlPath& path) {
  std::string text;
  for (const auto& step : path) {
    const auto* const key = std::get_if<std::string>(&step);
    text += key != nullptr ? "/" + *key : fmt::format("[{}]", std::get<std::size_t>(step));
  }
  return text;
}

void list(const std::vector<TomlItem>& items, std::string_view text, std::string& out) {
  for (const TomlItem& item : items) {
    out += words(item.path) + " <" + std::string(text.substr(item.value, item.end - item.value)) + ">";
    for (const TomlKey& key : item.keys)
      out += fmt::format(" {}:{}", key.depth, text.substr(key.begin, key.end - key.begin));
    out += '\n';
    list(item.inner, text, out);
  }
}

std::string listed(std::string_view text) {
  std::string out;
  list(toml_layout(text), text, out);
  return out;
}

TEST(TomlLayout, HasLinesAndHeaders) {
  EXPECT_EQ(listed("\xEF\xBB\xBF# a = 1\nt = 'x # y'  # said\n\n  [ a . \"b c\" ]\r\n  k-1 = 1.5 # c\r\n"),
            "/t <'x # y'> 0:t\n"
            "/a/b c <> 0:a 1:\"b c\"\n"
            "/a/b c/k-1 <1.5> 2:k-1\n");
  EXPECT_EQ(listed("d = 1979-05-27 07:32:00 \ne = -3"), "/d <1979-05-27 07:32:00> 0:d\n/e <-3> 0:e\n");
}

TEST(TomlLayout, HasKeysWithDotsAndInQuotes) {
  EXPECT_EQ(listed("a.\"b.\\u0063\" . 'd' = 1\n[t]\nx.y = 2\n"),
            "/a/b.c/d <1> 0:a 1:\"b.\\u0063\" 2:'d'\n"
            "/t <> 0:t\n"
            "/t/x/y <2> 1:x 2:y\n");
}

TEST(TomlLayout, HasWhatIsBetweenBracketsAndBraces) {
  EXPECT_EQ(listed("a = [ 1, # one ]\n  \"2]\", [],\n]\nb = { c.d = [3], e = {} }\n"),
            "/a <[ 1, # one ]\n  \"2]\", [],\n]> 0:a\n"
            "/a[0] <1>\n/a[1] <\"2]\">\n/a[2] <[]>\n"
            "/b <{ c.d = [3], e = {} }> 0:b\n"
            "/b/c/d <[3]> 1:c 2:d\n/b/c/d[0] <3>\n/b/e <{}> 1:e\n");
}

TEST(TomlLayout, CountsTheTablesOfArrays) {
  EXPECT_EQ(listed("[[a]]\nx = 1\n[[a]]\n[[a.b]]\n[a.b.c]\ny = 2\n"),
            "/a[0] <> 0:a\n/a[0]/x <1> 2:x\n"
            "/a[1] <> 0:a\n/a[1]/b[0] <> 0:a 2:b\n/a[1]/b[0]/c <> 0:a 2:b 4:c\n"
            "/a[1]/b[0]/c/y <2> 5:y\n");
}

TEST(TomlLayout, HasStringsOfSeveralLinesAndTypesetSpaces) {
  EXPECT_EQ(listed("a\u00a0= \"\"\"x\n[b]\n\"\"\"\nc = '''d'''\n"),
            "/a <\"\"\"x\n[b]\n\"\"\"> 0:a\n/c <'''d'''> 0:c\n");
}

// Whatever it is given it comes to an end; what it says of a text that is no TOML means nothing.
TEST(TomlLayout, EndsWhereTheTextDoes) {
  for (const char* const broken :
       {"[", "[[", "a", "a.", "a = [", "a = {b", "a = [1, {", "=", "]]]", "a = ]\n[b"})
    for (const TomlItem& item : toml_layout(broken)) EXPECT_LE(item.end, std::string_view(broken).size());
}

TEST(TomlLayout, TellsWhichPathLeadsThroughWhich) {
  EXPECT_TRUE(leads_through({"a", 0UL, "b"}, {"a", 0UL}));
  EXPECT_TRUE(leads_through({"a"}, {"a"}));
  EXPECT_TRUE(leads_through({"a"}, {}));
  EXPECT_FALSE(leads_through({"a", 1UL}, {"a", 0UL}));
  EXPECT_FALSE(leads_through({"a"}, {"a", 0UL}));
}

}  // namespace
}  // namespace oblique::text
