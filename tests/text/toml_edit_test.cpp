// SPDX-License-Identifier: MIT
#include <oblique/text/toml_edit.h>

#include <gtest/gtest.h>

#include <oblique/text/diagnostic.h>

namespace oblique::text {
namespace {

using Kind = TomlChange::Kind;

const std::string toml_source = R"toml(# head
title = "φ·ψ"   # said

[blocks]   # all of them
# the angle
phi  = { type = "integrator", in = ["one"], initial = 0 }   # φ
c    = { type = "servo", in = [ "c2",  # first
   '-a2', "2*abc" ], gain = 1e5 }
[blocks.d]
type = "x"
in = "c"

# after d
[layout]
c = [1, 2]
)toml";

std::string edited(Kind kind, TomlPath path, const std::string& value = {},
                   const std::string& text = toml_source) {
  return edit_toml(text, "x", {{kind, std::move(path), value}});
}

/// The text with the first `from` replaced: what a hand would have written.
std::string by_hand(const std::string& from, const std::string& to, std::string text = toml_source) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(TomlEdit, SetsAValueAndLeavesTheRest) {
  EXPECT_EQ(edited(Kind::set, {"blocks", "c", "gain"}, "\"10 k\""), by_hand("1e5", "\"10 k\""));
  EXPECT_EQ(edited(Kind::set, {"title"}, "\"t\""), by_hand("\"φ·ψ\"", "\"t\""));
  EXPECT_EQ(edited(Kind::set, {"blocks", "c", "in", 1UL}, "\"-3*a2\""), by_hand("'-a2'", "\"-3*a2\""));
  EXPECT_EQ(edited(Kind::set, {"blocks", "d", "in"}, "[\"c\", \"phi\"]"),
            by_hand("in = \"c\"", "in = [\"c\", \"phi\"]"));
  EXPECT_EQ(edited(Kind::set, {"layout", "c"}, "[3.5, 2]"), by_hand("[1, 2]", "[3.5, 2]"));
}

TEST(TomlEdit, AddsAtTheEndOfTablesAndArrays) {
  EXPECT_EQ(edited(Kind::set, {"blocks", "phi", "label"}, "\"φ\""),
            by_hand("initial = 0 }", "initial = 0, label = \"φ\" }"));
  EXPECT_EQ(edited(Kind::set, {"blocks", "c", "in", 3UL}, "\"x\""),
            by_hand("\"2*abc\" ]", "\"2*abc\", \"x\" ]"));
  EXPECT_EQ(edited(Kind::set, {"blocks", "e"}, "{ type = \"y\" }"),
            by_hand("gain = 1e5 }\n", "gain = 1e5 }\ne    = { type = \"y\" }\n"));
  EXPECT_EQ(edited(Kind::set, {"blocks", "d", "gain"}, "2"),
            by_hand("in = \"c\"\n", "in = \"c\"\ngain = 2\n"));
  EXPECT_EQ(edited(Kind::set, {"outputs", "y"}, "\"c\""), toml_source + "\n[outputs]\ny = \"c\"\n");
  EXPECT_EQ(edited(Kind::set, {"source"}, "\"s\""), by_hand("# said\n", "# said\nsource = \"s\"\n"));
}

TEST(TomlEdit, AddsToWhatIsEmpty) {
  EXPECT_EQ(edited(Kind::set, {"blocks", "c"}, "1", "[blocks]"), "[blocks]\nc = 1\n");
  EXPECT_EQ(edited(Kind::set, {"blocks", "c"}, "1", "[blocks]\n\n[run]\n"), "[blocks]\nc = 1\n\n[run]\n");
  EXPECT_EQ(edited(Kind::set, {"b", "c"}, "1", "b = {}\n"), "b = { c = 1 }\n");
  EXPECT_EQ(edited(Kind::set, {"b", 0UL}, "1", "b = [ ]\n"), "b = [1]\n");
  EXPECT_EQ(edited(Kind::set, {"b", "c"}, "1", ""), "[b]\nc = 1\n");
  EXPECT_EQ(edited(Kind::set, {"t"}, "1", "\xEF\xBB\xBF[b]\n"), "\xEF\xBB\xBFt = 1\n[b]\n");
}

TEST(TomlEdit, RemovesWithLineOrComma) {
  EXPECT_EQ(edited(Kind::remove, {"blocks", "c", "in", 0UL}), by_hand("\"c2\",  # first\n   '-a2'", "'-a2'"));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "c", "in", 2UL}), by_hand(", \"2*abc\"", ""));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "phi", "type"}), by_hand("type = \"integrator\", ", ""));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "phi", "initial"}), by_hand(", initial = 0", ""));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "phi"}),
            by_hand("phi  = { type = \"integrator\", in = [\"one\"], initial = 0 }   # φ\n", ""));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "d"}), by_hand("[blocks.d]\ntype = \"x\"\nin = \"c\"\n\n", ""));
  EXPECT_EQ(edited(Kind::remove, {"layout", "c"}), by_hand("c = [1, 2]\n", ""));
}

TEST(TomlEdit, RenamesInItsColumns) {
  EXPECT_EQ(edited(Kind::rename, {"blocks", "phi"}, "a"), by_hand("phi  =", "a    ="));
  EXPECT_EQ(edited(Kind::rename, {"blocks", "c"}, "longer_than_that"),
            by_hand("c    =", "longer_than_that ="));
  EXPECT_EQ(edited(Kind::rename, {"blocks", "d"}, "e"), by_hand("[blocks.d]", "[blocks.e]"));
  EXPECT_EQ(edited(Kind::rename, {"layout", "c"}, "dd"), by_hand("c = [1", "dd = [1"));
  EXPECT_EQ(edited(Kind::rename, {"blocks", "phi", "in"}, "x"), by_hand("in = [\"one\"]", "x = [\"one\"]"));
}

// Of a table that is written by keys with dots.
const std::string dotted = R"toml(title = "t"
[blocks]
x.type  = "integrator"   # that one
x.in    = ["4*a", "-4*x"]
a.type = "constant"
"x y"."a.b" = { p.q = 1, p.r = 2, s = 3 }
)toml";

TEST(TomlEdit, ChangesKeysWithDots) {
  EXPECT_EQ(edited(Kind::set, {"blocks", "x", "in", 1UL}, "\"-x\"", dotted),
            by_hand("\"-4*x\"", "\"-x\"", dotted));
  EXPECT_EQ(edited(Kind::set, {"blocks", "x", "initial"}, "0.5", dotted),
            by_hand("\"-4*x\"]\n", "\"-4*x\"]\nx.initial = 0.5\n", dotted));
  EXPECT_EQ(edited(Kind::set, {"blocks", "a", "value"}, "2", dotted),
            by_hand("\"constant\"\n", "\"constant\"\na.value = 2\n", dotted));
  EXPECT_EQ(edited(Kind::set, {"blocks", "x y", "n"}, "2", dotted),
            by_hand("s = 3 }\n", "s = 3 }\n\"x y\".n = 2\n", dotted));
  EXPECT_EQ(edited(Kind::set, {"blocks", "x y", "a.b", "p", "t"}, "4", dotted),
            by_hand("p.r = 2", "p.r = 2, p.t = 4", dotted));
  EXPECT_EQ(edited(Kind::set, {"blocks", "new"}, "{ type = \"y\" }", dotted),
            dotted + "new = { type = \"y\" }\n");
}

TEST(TomlEdit, RemovesKeysWithDots) {
  EXPECT_EQ(edited(Kind::remove, {"blocks", "x", "in"}, "", dotted),
            by_hand("x.in    = [\"4*a\", \"-4*x\"]\n", "", dotted));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "x"}, "", dotted),
            by_hand("x.type  = \"integrator\"   # that one\nx.in    = [\"4*a\", \"-4*x\"]\n", "", dotted));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "x y", "a.b", "p"}, "", dotted),
            by_hand("p.q = 1, p.r = 2, ", "", dotted));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "x y", "a.b", "p", "r"}, "", dotted),
            by_hand(", p.r = 2", "", dotted));
  // a table with tables below it, and comments between
  EXPECT_EQ(edited(Kind::remove, {"b", "d"}, "", "[b.d]\nx = 1\n# of d\ny = 2\n\n[b.d.e]\nz = 3\n\n[b.f]\n"),
            "[b.f]\n");
}

TEST(TomlEdit, RenamesKeysWithDots) {
  EXPECT_EQ(edited(Kind::rename, {"blocks", "x"}, "yy", dotted),
            by_hand("x.in    =", "yy.in   =", by_hand("x.type  =", "yy.type =", dotted)));
  EXPECT_EQ(edited(Kind::rename, {"blocks", "x y"}, "z", dotted), by_hand("\"x y\".", "z.", dotted));
  EXPECT_EQ(edited(Kind::rename, {"blocks", "x y", "a.b", "p"}, "w", dotted),
            by_hand("p.q = 1, p.r", "w.q = 1, w.r", dotted));
  EXPECT_EQ(edited(Kind::rename, {"a"}, "c d", "[ a . b ]\nx = 1\n[a.e]\n"),
            "[ \"c d\" . b ]\nx = 1\n[\"c d\".e]\n");
}

TEST(TomlEdit, ChangesQuotedKeys) {
  const std::string quoted =
      "[blocks]\n\"x\" = { 'type' = \"a\" }\n'y'  = { type = \"b\" }\n[\"blocks\".\"z\"]\ntype = 1\n";
  EXPECT_EQ(edited(Kind::set, {"blocks", "x", "type"}, "\"c\"", quoted), by_hand("\"a\"", "\"c\"", quoted));
  EXPECT_EQ(edited(Kind::rename, {"blocks", "y"}, "w", quoted), by_hand("'y'", "w", quoted));
  EXPECT_EQ(edited(Kind::rename, {"blocks", "z"}, "w", quoted), by_hand("\"z\"", "w", quoted));
  EXPECT_EQ(edited(Kind::remove, {"blocks", "x"}, "", quoted),
            by_hand("\"x\" = { 'type' = \"a\" }\n", "", quoted));
  EXPECT_EQ(edited(Kind::set, {"blocks", "z", "gain"}, "2", quoted), quoted + "gain = 2\n");
}

TEST(TomlEdit, ChangesTablesOfArrays) {
  const std::string steps = "[[s.t]]\nx = 1\n[s.t.u]\ny = 2\n[[s.t]]\nx = 3\n";
  EXPECT_EQ(edited(Kind::set, {"s", "t", 1UL, "x"}, "4", steps), by_hand("x = 3", "x = 4", steps));
  EXPECT_EQ(edited(Kind::set, {"s", "t", 0UL, "u", "z"}, "4", steps),
            by_hand("y = 2\n", "y = 2\nz = 4\n", steps));
  EXPECT_EQ(edited(Kind::remove, {"s", "t", 0UL}, "", steps), "[[s.t]]\nx = 3\n");
}

TEST(TomlEdit, ChangesOneAfterTheOther) {
  EXPECT_EQ(edit_toml("[b]\nx = [1, 2]\n", "x",
                      {{Kind::remove, {"b", "x", 0UL}, {}},
                       {Kind::remove, {"b", "x", 0UL}, {}},
                       {Kind::rename, {"b", "x"}, "y"},
                       {Kind::set, {"b", "y", 0UL}, "3"}}),
            "[b]\ny = [3]\n");
}

TEST(TomlEdit, AddsManyInTheirOrder) {
  std::vector<TomlChange> changes;
  std::string expected = "[a]\nx = 0\n";
  for (int k = 0; k < 300; ++k) {
    const std::string name = "y" + std::to_string(k);
    changes.push_back({Kind::set, {"a", name}, std::to_string(k)});
    expected += name + " = " + std::to_string(k) + "\n";
  }
  changes.push_back({Kind::set, {"a", "y3"}, "7"});  // one of them again
  expected.replace(expected.find("y3 = 3"), 6, "y3 = 7");
  EXPECT_EQ(edit_toml("[a]\nx = 0\n\n[b]\n", "x", changes), expected + "\n[b]\n");
  EXPECT_EQ(edit_toml("[a]\nx = 0\n", "x", {{Kind::set, {"a", "y"}, "1"}, {Kind::set, {"a", "z"}, "2"}}),
            "[a]\nx = 0\ny = 1\nz = 2\n");
  // at places of their own, whatever their order; one within another that is set before it
  EXPECT_EQ(edit_toml("[a]\nx = [0, 1]\ny = { z = 1 }\n", "x",
                      {{Kind::set, {"a", "y", "z"}, "2"},
                       {Kind::set, {"a", "x", 1UL}, "3"},
                       {Kind::set, {"a", "x", 0UL}, "4"},
                       {Kind::set, {"a", "y"}, "{ z = 5, w = 6 }"},
                       {Kind::set, {"a", "y", "w"}, "7"},
                       {Kind::set, {"b", "c"}, "1"},
                       {Kind::set, {"b", "d"}, "2"}}),
            "[a]\nx = [4, 3]\ny = { z = 5, w = 7 }\n\n[b]\nc = 1\nd = 2\n");
}

TEST(TomlEdit, KeepsOtherBreaksOfLines) {
  EXPECT_EQ(edited(Kind::set, {"b", "d"}, "2", "[b]\r\nc = 1\r\n"), "[b]\r\nc = 1\r\nd = 2\r\n");
  EXPECT_EQ(edited(Kind::remove, {"b", "c"}, "", "[b]\r\nc = 1\r\nd = 2\r\n"), "[b]\r\nd = 2\r\n");
}

std::string refusal(const std::string& text, const TomlChange& change) {
  try {
    const std::string made = edit_toml(text, "x.toml", {change});
    return "made: " + made;
  } catch (const ReadError& error) {
    return error.what();
  }
}

TEST(TomlEdit, SaysWhatItCannotChange) {
  const std::string whole =
      "x.toml: 'a.b' cannot be changed as it is written; expected an entry of a table, on a line of its own "
      "or between "
      "braces\n  remedy: change it in the text";
  EXPECT_EQ(refusal("a.b = 1\n", {Kind::remove, {"a", "b"}, {}}), whole);
  EXPECT_EQ(refusal("a = 1\n", {Kind::set, {"a", "b"}, "2"}), whole);
  EXPECT_EQ(refusal("[a]\n", {Kind::remove, {"a", "b"}, {}}), whole);
  // a key that is there already
  EXPECT_EQ(refusal("[a]\nb = 1\nc = 2\n", {Kind::rename, {"a", "b"}, "c"}), whole);
  EXPECT_EQ(refusal("[a]\nb = 1\n", {Kind::set, {"a", "b"}, "1 } ["}).find("made"), std::string::npos);
}

}  // namespace
}  // namespace oblique::text
