// SPDX-License-Identifier: MIT
#include <oblique/diagram/edit/diagram_edit.h>

#include <filesystem>
#include <functional>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/edit/written_wires.h>
#include <oblique/diagram/flatten.h>
#include <oblique/text/file.h>

namespace oblique::diagram {
namespace {

const BlockLibrary& library() {
  static const BlockLibrary shipped = BlockLibrary::shipped();
  return shipped;
}

const std::string empty_diagram = "format = \"oblique-diagram/1\"\n\n[blocks]\n";

const std::string edited_diagram = R"toml(format = "oblique-diagram/1"

[run]
until = 4
tolerances = { x = 1e-9 }

[blocks]   # the machine
a = { type = "constant", value = 0.5 }   # of x
x = { type = "integrator", in = ["4*a", "-4*x"], initial = 0 }
p = { type = "multiplier", in = ["a", "x"] }
q = { type = "multiplier", x = "-x/2", y = "p" }

[outputs]
y = { signal = "x", unit = "x" }
z = "p"

[expect]
"y at 4" = { value = 0.5, within = 1e-3 }

[layout]
x = [10, 4]
)toml";

std::string edited(const std::function<void(DiagramEdit&)>& work, const std::string& text = edited_diagram) {
  DiagramEdit edit(text, "x.toml", library());
  work(edit);
  return edit.text();
}

std::string by_hand(const std::string& from, const std::string& to, std::string text = edited_diagram) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refused(const std::function<void(DiagramEdit&)>& work, const std::string& text = edited_diagram) {
  DiagramEdit edit(text, "x.toml", library());
  try {
    work(edit);
  } catch (const text::Error& error) {
    EXPECT_EQ(edit.text(), text);
    return error.what();
  }
  return "done: " + edit.text();
}

/// The triangle of diagrams/lessons/triangle-side.toml, patched from nothing.
TEST(DiagramEdit, PatchesATriangleFromNothing) {
  const std::string made = edited(
      [](DiagramEdit& edit) {
        for (const char* const constant : {"one", "a", "b"}) edit.add("constant", constant);
        edit.set("one", "value", "1.0");
        edit.set("a", "value", "0.30");
        edit.set("b", "value", "0.40");
        edit.add("integrator", "phi");
        edit.connect("one", "phi", "in");
        edit.set("phi", "label", "φ");
        edit.set("phi", "initial", "0");
        edit.add("cosine", "cosp");
        edit.connect("phi", "cosp", "in");
        edit.set("cosp", "label", "cos φ");
        const auto product = [&](const char* name, const char* x, const char* y, const char* label) {
          edit.add("multiplier", name);
          edit.connect(x, name, "x");
          edit.connect(y, name, "y");
          if (*label != '\0') edit.set(name, "label", label);
        };
        product("a2", "a", "a", "a²");
        product("b2", "b", "b", "b²");
        edit.add("servo-amplifier", "c");
        product("c2", "c", "c", "c²");
        product("ab", "a", "b", "");
        product("abc", "ab", "cosp", "a b cos φ");
        edit.connect("c2", "c", "in");
        edit.connect("a2", "c", "in", -1);
        edit.connect("b2", "c", "in");
        edit.weigh("c", "in", 2, -1);
        edit.connect("abc", "c", "in", 2);
        edit.set("c", "gain", "1e5");
        edit.set("c", "bandwidth", "10 Hz");
        edit.show("side", "c");
        edit.set_head("title", "By hand");
        edit.set_head("run.until", "2*pi");
      },
      empty_diagram);
  const Diagram patched = parse_diagram(made, "patched");
  const FlatDiagram flat = flatten(patched, library());
  const FlatDiagram shipped = flatten(
      read_diagram(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/lessons/triangle-side.toml"), library());
  EXPECT_EQ(patched.title, "By hand");
  EXPECT_DOUBLE_EQ(patched.run.until, 2 * 3.14159265358979323846);
  ASSERT_EQ(flat.blocks.size(), shipped.blocks.size());
  for (const FlatBlock& block : shipped.blocks) {
    SCOPED_TRACE(block.path);
    const auto same = std::find_if(flat.blocks.begin(), flat.blocks.end(),
                                   [&](const FlatBlock& other) { return other.path == block.path; });
    ASSERT_NE(same, flat.blocks.end());
    EXPECT_EQ(same->parameters, block.parameters);
    ASSERT_EQ(same->inputs.size(), block.inputs.size());
    for (std::size_t k = 0; k < block.inputs.size(); ++k) {
      ASSERT_EQ(same->inputs[k].terms.size(), block.inputs[k].terms.size());
      for (std::size_t t = 0; t < block.inputs[k].terms.size(); ++t) {
        const auto& mine = same->inputs[k].terms[t];
        const auto& theirs = block.inputs[k].terms[t];
        EXPECT_EQ(mine.weight, theirs.weight);
        EXPECT_EQ(flat.blocks[mine.signal.block].path, shipped.blocks[theirs.signal.block].path);
      }
    }
  }
}

TEST(DiagramEdit, WiresAsTheFileHasIt) {
  const auto connected = [](const char* signal, const char* block, const char* port, double weight = 1) {
    return edited([&](DiagramEdit& edit) { edit.connect(signal, block, port, weight); });
  };
  EXPECT_EQ(connected("p", "x", "in", 0.25), by_hand("\"-4*x\"]", "\"-4*x\", \"0.25*p\"]"));
  EXPECT_EQ(connected("x", "p", "x"), by_hand("in = [\"a\", \"x\"]", "in = [\"x\", \"x\"]"));
  EXPECT_EQ(connected("a", "q", "y", -1), by_hand("y = \"p\"", "y = \"-a\""));
  const std::string one = empty_diagram + "x = { type = \"integrator\", in = \"x\" }\n";
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.connect("x", "x", "in", -1); }, one),
            by_hand("in = \"x\"", "in = [\"x\", \"-x\"]", one));
  const std::string none = empty_diagram + "x = { type = \"integrator\", in = [] }\n";
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.connect("x", "x", "in"); }, none),
            by_hand("in = []", "in = [\"x\"]", none));
}

TEST(DiagramEdit, CutsWires) {
  const auto cut = [](const char* block, const char* port, std::size_t term) {
    return edited([&](DiagramEdit& edit) { edit.disconnect(block, port, term); });
  };
  EXPECT_EQ(cut("x", "in", 0), by_hand("\"4*a\", ", ""));
  EXPECT_EQ(cut("p", "y", 0), by_hand("[\"a\", \"x\"]", "[\"a\"]"));
  EXPECT_EQ(cut("p", "x", 0), by_hand("in = [\"a\", \"x\"]", "y = \"x\""));  // the list counted the inputs
  EXPECT_EQ(cut("q", "x", 0), by_hand("x = \"-x/2\", ", ""));
}

TEST(DiagramEdit, WeighsWires) {
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.weigh("q", "x", 0, 3); }), by_hand("-x/2", "3*x"));
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.weigh("x", "in", 1, -1); }), by_hand("-4*x", "-x"));
}

TEST(DiagramEdit, KnowsTheSignalOfAWire) {
  std::vector<text::Entry> settings{wire_setting("in", {{1, "x"}})};
  for (const auto& [written, signal] :
       std::vector<std::pair<const char*, const char*>>{{"-2*b.cos", "b.cos"},
                                                        {"0.1*sin(pi/10)*u1 ", "u1"},
                                                        {"1e3*x/2", "x"},
                                                        {"a*b", ""},
                                                        {"2*pi", ""}}) {
    settings[0].value.text = written;
    EXPECT_EQ(wires_of(settings, library().find("integrator")).at(0).signal, signal) << written;
  }
}

TEST(DiagramEdit, SetsWhatAPersonWrites) {
  const auto set = [](const char* value) {
    return edited([&](DiagramEdit& edit) { edit.set("a", "value", value); });
  };
  for (const auto& [written, kept] : std::vector<std::pair<const char*, const char*>>{
           {"0.25", "0.25"},
           {" 1e-3 ", "1e-3"},
           {"2*pi", "\"2*pi\""},
           {"10 Hz", "\"10 Hz\""},
           {"01", "\"01\""},
           {".5", "\".5\""},
           {"1.", "\"1.\""},
           {"[[0, 1], [1, 2]]", "[[0, 1], [1, 2]]"},
           {"[[0, 1", "\"[[0, 1\""},
           {"{ file = \"a.csv\", x = \"t\" }", "{ file = \"a.csv\", x = \"t\" }"}}) {
    EXPECT_EQ(set(written), by_hand("value = 0.5", std::string("value = ") + kept)) << written;
  }
  EXPECT_EQ(set(""), by_hand(", value = 0.5", ""));
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.set("a", "label", "1"); }),
            by_hand("value = 0.5", "value = 0.5, label = \"1\""));
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.set("a", "initial", ""); }), edited_diagram);
}

TEST(DiagramEdit, RenamesWhereverTheFileNamesIt) {
  std::string expected = edited_diagram;
  for (const auto& [from, to] :
       std::vector<std::pair<const char*, const char*>>{{"{ x = 1e-9", "{ speed = 1e-9"},
                                                        {"x = { type", "speed = { type"},
                                                        {"\"-4*x\"", "\"-4*speed\""},
                                                        {"\"a\", \"x\"", "\"a\", \"speed\""},
                                                        {"\"-x/2\"", "\"-speed/2\""},
                                                        {"signal = \"x\", unit", "signal = \"speed\", unit"},
                                                        {"x = [10", "speed = [10"}})
    expected = by_hand(from, to, expected);
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.rename("x", "speed"); }), expected);
  const std::string timed = empty_diagram + R"toml(c = { type = "comparator", in = "e2.x" }
e2 = { type = "x" }

[groups]
g = { blocks = ["e2"], hold = "c" }

[timeline]
phases = [{ mode = "operate", until = "e2 > 2" }]

[expect]
"e2 maximum" = { value = 1, within = 1 }
)toml";
  std::string renamed = timed;
  for (const auto& [from, to] : std::vector<std::pair<const char*, const char*>>{{"\"e2.x\"", "\"d.x\""},
                                                                                 {"e2 = {", "d = {"},
                                                                                 {"[\"e2\"]", "[\"d\"]"},
                                                                                 {"\"e2 >", "\"d >"},
                                                                                 {"\"e2 max", "\"d max"}})
    renamed = by_hand(from, to, renamed);
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.rename("e2", "d"); }, timed), renamed);
}

// What is set for a published value or a step of a lesson names a block, and so does an answer; where a
// diagram lists no outputs, what is expected of its signals does too.
TEST(DiagramEdit, RenamesInWhatWasPublishedAndInLessons) {
  const std::string published = empty_diagram + R"toml(x = { type = "integrator", in = ["-2*x"], initial = 1 }

[published]
plot = ["x"]

[[published.value]]
name = "x"
at = "minimum"
set = { "x.in[1]" = 3, "y.in[1]" = 3 }

[[lesson.step]]
do = "turn x up"
set = { "x.initial" = 2 }
expect = { "x maximum" = 2 }

[lesson.question]
ask = "and x?"
answer = "x.initial"
expect = { "x at 0" = 3 }
)toml";
  std::string renamed = published;
  for (const auto& [from, to] :
       std::vector<std::pair<const char*, const char*>>{{"x = {", "speed = {"},
                                                        {"-2*x", "-2*speed"},
                                                        {"[\"x\"]", "[\"speed\"]"},
                                                        {"name = \"x\"", "name = \"speed\""},
                                                        {"{ \"x.in[1]\"", "{ \"speed.in[1]\""},
                                                        {"\"x.initial\" = 2", "\"speed.initial\" = 2"},
                                                        {"\"x maximum\"", "\"speed maximum\""},
                                                        {"= \"x.initial\"", "= \"speed.initial\""},
                                                        {"\"x at 0\"", "\"speed at 0\""}})
    renamed = by_hand(from, to, renamed);
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.rename("x", "speed"); }, published), renamed);
  // With outputs, what is plotted and expected is theirs.
  const std::string outputs = "\n[outputs]\nx = \"x\"\n";
  std::string settings = published + outputs;
  for (const auto& [from, to] :
       std::vector<std::pair<const char*, const char*>>{{"x = {", "speed = {"},
                                                        {"-2*x", "-2*speed"},
                                                        {"{ \"x.in[1]\"", "{ \"speed.in[1]\""},
                                                        {"\"x.initial\" = 2", "\"speed.initial\" = 2"},
                                                        {"= \"x.initial\"", "= \"speed.initial\""},
                                                        {"x = \"x\"", "x = \"speed\""}})
    settings = by_hand(from, to, settings);
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.rename("x", "speed"); }, published + outputs), settings);
}

// Whatever a shipped diagram names its blocks by, it can be read when each has another name.
TEST(DiagramEdit, RenamesTheBlocksOfEveryShippedDiagram) {
  int renamed = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(OBLIQUE_SOURCE_DIR "/diagrams")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string text = text::read_file(entry.path());
    if (text.find("\"oblique-diagram/1\"") == std::string::npos) continue;
    if (entry.path().parent_path().filename() == "own-blocks") continue;  // whose blocks are not shipped
    SCOPED_TRACE(entry.path().string());
    DiagramEdit edit(text, entry.path().string(), library());
    const Diagram before = parse_diagram(text, entry.path().string());
    for (const BlockInstance& block : before.blocks) edit.rename(block.name, "renamed_" + block.name);
    const Diagram after = parse_diagram(edit.text(), entry.path().string());
    flatten(after, library());
    EXPECT_EQ(after.expectations.size(), before.expectations.size());
    ++renamed;
  }
  EXPECT_GT(renamed, 100);
}

TEST(DiagramEdit, RemovesABlockWithAllThatHangsOnIt) {
  std::string expected = edited_diagram;
  for (const auto& [from, to] : std::vector<std::pair<const char*, const char*>>{
           {"x = { type = \"integrator\", in = [\"4*a\", \"-4*x\"], initial = 0 }\n", ""},
           {"[\"a\", \"x\"]", "[\"a\"]"},
           {"x = \"-x/2\", ", ""},
           {"y = { signal = \"x\", unit = \"x\" }\n", ""},
           {"\"y at 4\" = { value = 0.5, within = 1e-3 }\n", ""},
           {"x = [10, 4]\n", ""}})
    expected = by_hand(from, to, expected);
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.remove("x"); }), expected);
}

TEST(DiagramEdit, ChoosesNamesThatAreFree) {
  const std::string made = edited(
      [](DiagramEdit& edit) {
        EXPECT_EQ(edit.add("servo-amplifier"), "servo_amplifier1");
        EXPECT_EQ(edit.add("servo-amplifier"), "servo_amplifier2");
        edit.place({{"servo_amplifier1", 4, 2.5, {}}});
        edit.show("y", "servo_amplifier2");
        edit.show("y", "servo_amplifier1");
      },
      empty_diagram);
  EXPECT_EQ(made, empty_diagram +
                      "servo_amplifier1 = { type = \"servo-amplifier\" }\nservo_amplifier2 = { type = "
                      "\"servo-amplifier\" }\n\n[layout]\nservo_amplifier1 = [4, 2.5]\n\n[outputs]\ny = "
                      "\"servo_amplifier1\"\n");
}

TEST(DiagramEdit, EditsWhatIsWrong) {
  const std::string wrong = empty_diagram + "x = { type = \"integrater\", in = [\"nobody\", 3] }\n";
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.set("x", "type", "integrator"); }, wrong),
            by_hand("integrater", "integrator", wrong));
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.disconnect("x", "in", 0); }, wrong),
            by_hand("\"nobody\", ", "", wrong));
}

// However its keys are written, all that a hand does to a diagram can be done to it.
TEST(DiagramEdit, EditsKeysWithDotsAndInQuotes) {
  const std::string text = R"toml(format = "oblique-diagram/1"
run.until = 4

[blocks]
a.type  = "constant"   # of x
a.value = 0.5
x.type    = "integrator"
x.in      = ["4*a", "-4*x"]
"p" = { type = "multiplier", "in" = ["a", 'x'] }

[outputs]
y.signal = "x"
y.unit = "m"
)toml";
  const std::string after = edited(
      [](DiagramEdit& edit) {
        edit.set("x", "initial", "0.1");
        edit.weigh("x", "in", 0, 2);
        edit.disconnect("x", "in", 1);
        edit.rename("x", "lag");
        edit.rename("p", "q");
        edit.connect("a", "q", "y");
        edit.set("a", "label", "A");
        edit.set_head("run.until", "8");
        edit.show("z", "q");
      },
      text);
  EXPECT_EQ(after, R"toml(format = "oblique-diagram/1"
run.until = 8

[blocks]
a.type  = "constant"   # of x
a.value = 0.5
a.label = "A"
lag.type  = "integrator"
lag.in    = ["2*a"]
lag.initial = 0.1
q = { type = "multiplier", "in" = ["a", "a"] }

[outputs]
y.signal = "lag"
y.unit = "m"
z = "q"
)toml");
  EXPECT_EQ(edited([](DiagramEdit& edit) { edit.remove("lag"); }, after), R"toml(format = "oblique-diagram/1"
run.until = 8

[blocks]
a.type  = "constant"   # of x
a.value = 0.5
a.label = "A"
q = { type = "multiplier", "in" = ["a", "a"] }

[outputs]
z = "q"
)toml");
}

TEST(DiagramEdit, SaysWhatItCannot) {
  EXPECT_EQ(refused([](DiagramEdit& edit) { edit.add("integrater"); }),
            "x.toml: there is no block type 'integrater'\n  remedy: did you mean 'integrator'?");
  EXPECT_EQ(refused([](DiagramEdit& edit) { edit.rename("x", "p"); }),
            "x.toml: there is a block 'p' already; expected another name");
  EXPECT_EQ(refused([](DiagramEdit& edit) { edit.rename("x", "2p"); }),
            "x.toml: '2p' cannot be the name of a block; expected letters, digits and '_', with a letter or "
            "'_' first");
  EXPECT_EQ(refused([](DiagramEdit& edit) { edit.remove("y"); }),
            "x.toml: there is no block 'y'; expected the name of a block of this file\n  remedy: known: a, "
            "x, p, q");
  EXPECT_EQ(refused([](DiagramEdit& edit) { edit.connect("x", "p", "z"); }),
            "x.toml: block 'p' (multiplier) has no input 'z'\n  remedy: known: x, y");
  EXPECT_EQ(refused([](DiagramEdit& edit) { edit.connect("x", "p", "x", 0); }),
            "x.toml: the weight of a wire is 0; expected a finite number other than 0");
  EXPECT_EQ(refused([](DiagramEdit& edit) { edit.disconnect("x", "in", 2); }),
            "x.toml: input 'x.in' has no wire number 3; expected one of its 2 wires");
}

}  // namespace
}  // namespace oblique::diagram
