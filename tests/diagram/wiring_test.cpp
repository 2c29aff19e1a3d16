// SPDX-License-Identifier: MIT
// What `flatten` says about wiring that is wrong. The blocks of a test stand from line 3 of "d.toml" on.
#include <oblique/diagram/flat_diagram.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using testing::diagram_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::small_library;
using testing::wiring_message;

const std::string kTwo = "a = { type = \"reference\" }\nb = { type = \"reference\" }\n";  // lines 3 and 4

/// The small library and a composite `box` with this text after its first two lines.
BlockLibrary with_box(const std::string& text, const std::string& name = "box",
                      BlockLibrary library = small_library()) {
  library.add(parse_block("format = \"oblique-block/1\"\ntitle = \"Box\"\n" + text, name + ".toml", name));
  return library;
}

TEST(Wiring, NamesTheNearestTypeForAnUnknownOne) {
  EXPECT_EQ(wiring_message("a = { type = \"referense\" }\n"),
            "d.toml:3:1: block 'a': there is no block type 'referense'\n  remedy: did you mean 'reference'?");
  EXPECT_EQ(wiring_message("a = { type = \"xyz\" }\n"),
            "d.toml:3:1: block 'a': there is no block type 'xyz'\n"
            "  remedy: known: adder, cosine-of, product, reference, resolver, servo");
}

TEST(Wiring, BlocksOfUnknownTypeCauseNoFurtherMessages) {
  EXPECT_EQ(wiring_message(
                "a = { type = \"referense\", in = \"nobody\" }\nb = { type = \"adder\", in = \"a.x\" }\n"),
            "d.toml:3:1: block 'a': there is no block type 'referense'\n  remedy: did you mean 'reference'?");
}

TEST(Wiring, NamesTheNearestKeyForAnUnknownOne) {
  EXPECT_EQ(
      wiring_message("a = { type = \"servo\", in = \"a\", gian = 3 }\n"),
      "d.toml:3:33: block 'a' (servo) has no input and no parameter 'gian'\n  remedy: did you mean 'gain'?");
  EXPECT_EQ(wiring_message(kTwo + "c = { type = \"product\", in = [\"a\", \"b\"], z = \"a\" }\n"),
            "d.toml:5:42: block 'c' (product) has no input and no parameter 'z'\n  remedy: known: x, y");
}

//  nobody ──► [+] c
TEST(Wiring, NamesTheNearestSignalForAnUnknownOne) {
  EXPECT_EQ(wiring_message(
                "side = { type = \"reference\" }\nc = { type = \"adder\", in = [\"side\", \"-2*sied\"] }\n"),
            "d.toml:4:41: input 'c.in': there is no signal 'sied'\n  remedy: did you mean 'side'?");
  EXPECT_EQ(wiring_message("length = { type = \"reference\" }\nc = { type = \"adder\", in = \"lenght\" }\n"),
            "d.toml:4:29: input 'c.in': there is no signal 'lenght'\n  remedy: did you mean 'length'?");
}

//  [r] ═x,y═► [+] c
TEST(Wiring, ASignalOfABlockWithSeveralOutputsNamesItsPort) {
  const std::string r = "r = { type = \"resolver\" }\n";
  EXPECT_EQ(wiring_message(r + "c = { type = \"adder\", in = \"r\" }\n"),
            "d.toml:4:29: input 'c.in': 'r' has 2 outputs; expected one of r.x, r.y");
  EXPECT_EQ(wiring_message(r + "c = { type = \"adder\", in = \"r.z\" }\n"),
            "d.toml:4:29: input 'c.in': 'r' (resolver) has no output 'z'\n  remedy: known: x, y");
  EXPECT_EQ(wiring_message(r + "c = { type = \"adder\", in = \"r.x.y\" }\n"),
            "d.toml:4:29: input 'c.in': 'r.x' is a signal, so there is no 'r.x.y'; expected 'r.x'");
}

TEST(Wiring, OpenInputsAreErrors) {
  EXPECT_EQ(wiring_message("a = { type = \"adder\" }\n"),
            "d.toml:3:1: input 'a.in' (adder) is not connected; expected a signal\n"
            "  remedy: in = \"NAME OF A SIGNAL\", or in = [] where nothing is to be added");
  EXPECT_EQ(wiring_message("a = { type = \"adder\", in = [] }\n"), "") << "nothing is added, and says so";
  EXPECT_EQ(wiring_message(kTwo + "c = { type = \"product\", in = [\"a\"] }\n"),
            "d.toml:5:1: input 'c.y' (product) is not connected; expected a signal\n"
            "  remedy: y = \"NAME OF A SIGNAL\"");
}

TEST(Wiring, AnInputThatDoesNotSumTakesOneSignal) {
  EXPECT_EQ(wiring_message(kTwo + "c = { type = \"product\", x = [\"a\", \"b\"], y = \"a\" }\n"),
            "d.toml:5:35: input 'c.x' is doubly driven: it takes one signal and was given 2\n"
            "  remedy: add the signals in a block with a summing input and wire its output here");
  EXPECT_THAT(
      wiring_message(kTwo + "c = { type = \"cosine-of\", in = [\"a\", \"b\"] }\n"),
      HasSubstr("d.toml:5:38: input 'c.angle' is doubly driven: it takes one signal and was given 2"));
}

TEST(Wiring, AnInputIsGivenOnce) {
  EXPECT_EQ(wiring_message(kTwo + "c = { type = \"product\", in = [\"a\", \"b\"], y = \"a\" }\n"),
            "d.toml:5:42: input 'c.y' is doubly driven: by 'in' and by 'y'\n  remedy: keep one of the two");
  EXPECT_THAT(wiring_message(kTwo + "c = { type = \"product\", y = \"a\", in = [\"a\", \"b\"] }\n"),
              HasSubstr("d.toml:5:34: input 'c.y' is doubly driven: by 'y' and by 'in'"));
  EXPECT_THAT(wiring_message(kTwo + "c = { type = \"cosine-of\", angle = \"a\", in = \"b\" }\n"),
              HasSubstr("input 'c.angle' is doubly driven: by 'angle' and by 'in'"));
}

TEST(Wiring, AListOfInputsFitsTheBlock) {
  EXPECT_EQ(wiring_message(kTwo + "c = { type = \"product\", in = [\"a\", \"b\", \"a\"] }\n"),
            "d.toml:5:30: block 'c' (product) has 2 inputs (x, y), but 'in' lists 3\n"
            "  remedy: list one signal for each input");
  EXPECT_EQ(wiring_message(kTwo + "c = { type = \"reference\", in = \"a\" }\n"),
            "d.toml:5:32: block 'c' (reference) has no inputs, but 'in' lists 1\n  remedy: take 'in' away");
}

TEST(Wiring, AnInputTakesSignalsOnly) {
  EXPECT_THAT(wiring_message("c = { type = \"product\", in = 3, y = \"c\" }\n"),
              HasSubstr("d.toml:3:30: input 'c.x' is given the number 3; expected the name of a signal"));
  EXPECT_EQ(wiring_message("c = { type = \"adder\", in = 3 }\n"),
            "d.toml:3:28: input 'c.in' is given the number 3; expected the name of a signal\n"
            "  remedy: a fixed value comes from a block that gives a constant");
  EXPECT_EQ(wiring_message("c = { type = \"adder\", in = \"2*pi\" }\n"),
            "d.toml:3:29: input 'c.in': '2*pi' names no signal; expected [sign][weight*]signal\n"
            "  remedy: a fixed value comes from a block that gives a constant");
}

TEST(Wiring, AWireIsAWeightTimesOneSignal) {
  EXPECT_EQ(wiring_message(kTwo + "c = { type = \"adder\", in = \"a - 2*b\" }\n"),
            "d.toml:5:29: input 'c.in': 'a - 2*b' names 2 signals (a, b); expected [sign][weight*]signal "
            "with one signal\n"
            "  remedy: a sum is a list, [\"a\", \"-2*b\"]; a product takes a block that multiplies");
  EXPECT_THAT(wiring_message(kTwo + "c = { type = \"adder\", in = \"a*a\" }\n"),
              HasSubstr("'a*a' names 2 signals (a, a)"));
  for (const std::string wire : {"2/a", "a^2", "sin(a)", "a + 1", "2*(a + 1)", "a > 0"}) {
    EXPECT_THAT(wiring_message(kTwo + "c = { type = \"adder\", in = \"" + wire + "\" }\n"),
                HasSubstr("input 'c.in': 'a' is no plain factor of '" + wire +
                          "'; expected [sign][weight*]signal, such as "
                          "'-2*a' or 'a/3'\n  remedy: functions of a signal take a block of their own"));
  }
  EXPECT_EQ(wiring_message(kTwo + "c = { type = \"adder\", in = \"a/0\" }\n"),
            "d.toml:5:29: input 'c.in': the weight of 'a' is inf; expected a finite number");
  EXPECT_THAT(wiring_message(kTwo + "c = { type = \"adder\", in = \"0/0*a\" }\n"),
              HasSubstr("the weight of 'a' is not a number; expected a finite number"));
  EXPECT_THAT(wiring_message(kTwo + "c = { type = \"adder\", in = \"2*\" }\n"),
              HasSubstr("d.toml:5:31: input 'c.in': the expression ends too early"));
  EXPECT_THAT(wiring_message(kTwo + "c = { type = \"adder\", in = \"a b\" }\n"),
              HasSubstr("'b' does not belong here"));
}

TEST(Wiring, ChecksParameters) {
  const std::string c = kTwo + "c = { type = \"servo\", in = \"a\", ";  // the setting starts in column 34
  EXPECT_EQ(wiring_message(c + "gain = -5 }\n"),
            "d.toml:5:40: parameter 'c.gain' is -5; expected a number above 0");
  EXPECT_EQ(wiring_message(c + "damping = \"3/2\" }\n"),
            "d.toml:5:43: parameter 'c.damping' is 1.5; expected a number at least 0 and at most 1");
  EXPECT_EQ(wiring_message(c + "bandwidth = \"-1 kHz\" }\n"),
            "d.toml:5:45: parameter 'c.bandwidth' is -1000; expected a number above 0 [Hz]");
  EXPECT_EQ(wiring_message(c + "bandwidth = \"10 kg\" }\n"),
            "d.toml:5:49: parameter 'c.bandwidth': 'kg' is the wrong unit here; expected a quantity in 'Hz'\n"
            "  remedy: give it in 'Hz', or as a number without a unit");
  EXPECT_THAT(wiring_message(c + "bandwidth = \"10 hertz\" }\n"), HasSubstr("there is no unit 'hertz'"));
  EXPECT_THAT(wiring_message(c + "gain = nan }\n"),
              HasSubstr("parameter 'c.gain' is not a number; expected a number above 0"));
  EXPECT_THAT(wiring_message(c + "gain = \"0/0\" }\n"),
              HasSubstr("parameter 'c.gain' is not a number; expected a number above 0"));
  EXPECT_THAT(
      wiring_message(c + "initial = \"a\" }\n"),
      HasSubstr(
          "d.toml:5:44: parameter 'c.initial': 'a' is a signal; expected a number or a quantity in 'machine "
          "unit'\n  remedy: signals go to inputs, not to parameters"));
  EXPECT_THAT(
      wiring_message(c + "gain = \"2*mu\" }\n"),
      HasSubstr(
          "d.toml:5:43: parameter 'c.gain': 'mu' is no known constant; expected a number or a quantity in "
          "'1'"));
  EXPECT_THAT(wiring_message(c + "gain = [\"1\"] }\n"),
              HasSubstr("parameter 'c.gain' is a list; expected a number or a quantity in '1'"));
  EXPECT_THAT(wiring_message(c + "gain = \"2*\" }\n"),
              HasSubstr("parameter 'c.gain': the expression ends too early"));
  EXPECT_THAT(wiring_message("a = { type = \"reference\", value = inf }\n"),
              HasSubstr("parameter 'a.value' is inf; expected a number above -inf and below inf"));
}

TEST(Wiring, ReportsEveryMistakeTogetherInTheOrderOfTheFile) {
  try {
    flatten(parse_diagram(diagram_text("a = { type = \"adder\", in = [\"b\", \"zz\"] }\n"
                                       "b = { type = \"nix\" }\n"
                                       "c = { type = \"servo\", gain = 0, foo = 1 }\n"
                                       "d = { type = \"product\", x = \"a\", in = [\"a\", \"a\"] }\n",
                                       "[outputs]\no = \"p\"\n"),
                          "d.toml"),
            small_library(), {{"a.gain", "1"}});
    FAIL() << "no error";
  } catch (const DiagramError& error) {
    std::vector<int> lines;
    for (const text::Diagnostic& d : error.diagnostics()) lines.push_back(d.place.position.line);
    EXPECT_THAT(lines, ElementsAre(0, 3, 4, 5, 5, 5, 6, 8)) << error.what();
  }
}

TEST(Wiring, ChecksOutputsAndExpectations) {
  EXPECT_EQ(wiring_message(kTwo, small_library(), "[outputs]\nside = \"c\"\n"),
            "d.toml:6:8: output 'side': there is no signal 'c'\n  remedy: known: a, b");
  EXPECT_THAT(
      wiring_message("r = { type = \"resolver\" }\n", small_library(), "[outputs]\nx = { signal = \"r\" }\n"),
      HasSubstr("d.toml:5:16: output 'x': 'r' has 2 outputs; expected one of r.x, r.y"));
  EXPECT_THAT(wiring_message(kTwo, small_library(), "[outputs]\nx = \"2*a\"\n"),
              HasSubstr("there is no signal '2*a'"));
  // Without [outputs] the columns are all signals.
  const std::string expect = "[expect]\n\"r.x maximum\" = { value = 1, within = 1 }\n";
  EXPECT_EQ(wiring_message("r = { type = \"resolver\" }\n", small_library(), expect), "");
  EXPECT_EQ(wiring_message(kTwo, small_library(), expect),
            "d.toml:6:1: [expect] names 'r.x', which is no output\n  remedy: known: a, b");
}

TEST(Wiring, TwoBlocksOfOneNameAreAnError) {
  Diagram d = parse_diagram(diagram_text(kTwo), "d.toml");
  d.blocks[1].name = "a";
  EXPECT_EQ(message_of([&] { flatten(d, small_library()); }),
            "d.toml:4:1: there are two blocks 'a'; expected a name of its own for each block");
}

//  box: x ──► [+] s ──► y       k
TEST(Wiring, ChecksTheInsideOfCompositesOnce) {
  const std::string use = kTwo + "c = { type = \"box\", in = \"a\" }\nd = { type = \"box\", in = \"b\" }\n";
  const std::string ports =
      "[inputs]\nx = {}\n[outputs]\ny = { wire = \"s\" }\n[parameters]\nkappa = {}\n[blocks]\n";
  EXPECT_EQ(
      wiring_message(use, with_box(ports + "s = { type = \"adder\", in = \"kapa*x\" }\n")),
      "box.toml:10:29: input 's.in' of composite 'box': there is no signal 'kapa'\n  remedy: known: x, s");
  EXPECT_EQ(wiring_message(use, with_box(ports + "s = { type = \"adder\", in = \"x.y\" }\n")),
            "box.toml:10:29: input 's.in' of composite 'box': 'x' is an input of the composite, so there is "
            "no 'x.y'; "
            "expected 'x' alone");
  EXPECT_EQ(wiring_message(use, with_box(ports + "s = { type = \"servo\", in = \"x\", gain = \"kapa\" }\n")),
            "box.toml:10:41: parameter 's.gain' of composite 'box': 'kapa' is no known constant; expected a "
            "number or a "
            "quantity in '1'\n  remedy: did you mean 'kappa'?");
  EXPECT_EQ(wiring_message(use, with_box(ports + "s = { type = \"addre\", in = \"x\" }\n")),
            "box.toml:10:1: block 's' of composite 'box': there is no block type 'addre'\n  remedy: did you "
            "mean 'adder'?");
  EXPECT_EQ(wiring_message(use, with_box(ports + "s = { type = \"adder\", inn = \"x\" }\n")),
            "box.toml:10:1: input 's.in' of composite 'box' (adder) is not connected; expected a signal\n"
            "  remedy: in = \"NAME OF A SIGNAL\", or in = [] where nothing is to be added\n"
            "box.toml:10:23: block 's' (adder) of composite 'box' has no input and no parameter 'inn'\n"
            "  remedy: did you mean 'in'?");
}

TEST(Wiring, ChecksTheOutputsOfComposites) {
  const std::string use = kTwo + "c = { type = \"box\", x = \"a\" }\n";
  const auto box = [](const std::string& wire) {
    return with_box(
        "[inputs]\nx = {}\n[outputs]\ny = { wire = \"" + wire +
        "\" }\n[blocks]\nsum = { type = \"adder\", in = \"x\" }\ny = { type = \"adder\", in = \"x\" }\n");
  };
  EXPECT_EQ(wiring_message(use, box("y")), "");
  EXPECT_EQ(
      wiring_message(use, box("sun")),
      "box.toml:6:1: output 'y' of composite 'box': there is no signal 'sun'\n  remedy: did you mean 'sum'?");
  EXPECT_EQ(wiring_message(use, box("x")),
            "box.toml:6:1: output 'y' of composite 'box' shows the input 'x'; expected the signal of an "
            "inner block");
  EXPECT_EQ(wiring_message(use, box("sum")),
            "box.toml:6:1: output 'y' of composite 'box' has the name of an inner block but shows 'sum'; "
            "expected another "
            "name\n  remedy: 'block.name' would not say which of the two is meant");
}

//  C.direction.…: names that reach inside
TEST(Wiring, NamesWhatCompositesHold) {
  const BlockLibrary library = with_box(
      "[inputs]\nx = {}\n[outputs]\ny = { wire = \"sum\" }\nz = { wire = \"r.x\" }\n[blocks]\n"
      "sum = { type = \"adder\", in = \"x\" }\nr = { type = \"resolver\" }\n");
  const std::string use = kTwo + "c = { type = \"box\", x = \"a\" }\nd = { type = \"adder\", in = \"";
  EXPECT_EQ(wiring_message(use + "c.r.y\" }\n", library), "");
  EXPECT_EQ(wiring_message(use + "c.sun\" }\n", library),
            "d.toml:6:29: input 'd.in': 'c' (box) has no output and no inner block 'sun'\n  remedy: did you "
            "mean 'sum'?");
  EXPECT_EQ(wiring_message(use + "c.r\" }\n", library),
            "d.toml:6:29: input 'd.in': 'c.r' has 2 outputs; expected one of c.r.x, c.r.y");
  EXPECT_EQ(wiring_message(use + "c.r.z\" }\n", library),
            "d.toml:6:29: input 'd.in': 'c.r' (resolver) has no output 'z'\n  remedy: known: x, y");
  EXPECT_EQ(wiring_message(use + "c\" }\n", library),
            "d.toml:6:29: input 'd.in': 'c' has 2 outputs; expected one of c.y, c.z");
}

TEST(Wiring, ValuesThatFollowFromAComposite) {
  const std::string ports =
      "[inputs]\nx = {}\n[outputs]\ny = { wire = \"s\" }\n[parameters]\nk = { default = 1 }\n[blocks]\n";
  const std::string use = "a = { type = \"reference\" }\nc = { type = \"box\", in = \"a\", k = -2 }\n";
  EXPECT_EQ(wiring_message(use, with_box(ports + "s = { type = \"servo\", in = \"x\", gain = \"k/2\" }\n")),
            "box.toml:10:40: parameter 'c.s.gain' is -1; expected a number above 0\n"
            "  remedy: it follows from the parameters of 'c' (d.toml:4:1)");
  EXPECT_EQ(wiring_message(use, with_box(ports + "s = { type = \"servo\", in = \"x/(k + 2)\" }\n")),
            "box.toml:10:29: the weight 'c.s.in[1]' is inf; expected a finite number\n"
            "  remedy: it follows from the parameters of 'c' (d.toml:4:1)");
}

TEST(Wiring, ACompositeCannotContainItself) {
  const std::string use =
      "a = { type = \"reference\" }\nc = { type = \"box\", in = \"a\" }\nd = { type = \"adder\", in = \"c\" "
      "}\n";
  const auto around = [](const std::string& type) {
    return "[inputs]\nx = {}\n[outputs]\ny = { wire = \"s\" }\n[blocks]\ns = { type = \"" + type +
           "\", in = \"x\" }\n";
  };
  EXPECT_EQ(wiring_message(use, with_box(around("box"))),
            "box.toml:8:1: composite 'box' contains itself: box contains box\n"
            "  remedy: build one of them without the other");
  EXPECT_EQ(wiring_message(use, with_box(around("box"), "crate", with_box(around("crate")))),
            "crate.toml:8:1: composite 'box' contains itself: box contains crate contains box\n"
            "  remedy: build one of them without the other");
}

TEST(Wiring, CompositesMayNotBeNestedWithoutEnd) {
  BlockLibrary library = small_library();
  for (int i = 0; i < 120; ++i) {
    const std::string inner = i == 0 ? "adder" : "box" + std::to_string(i - 1);
    library = with_box("[inputs]\nx = {}\n[outputs]\ny = { wire = \"s\" }\n[blocks]\ns = { type = \"" +
                           inner + "\", in = \"x\" }\n",
                       "box" + std::to_string(i), std::move(library));
  }
  const std::string a = "a = { type = \"reference\" }\n";
  EXPECT_EQ(wiring_message(a + "c = { type = \"box99\", in = \"a\" }\n", library), "");
  EXPECT_EQ(wiring_message(a + "c = { type = \"box119\", in = \"a\" }\n", library),
            "box20.toml:8:1: composite 'box19' is nested too deeply; expected at most 100 composites around "
            "a block");
}

/// Forty levels of two boxes in a box would be a billion blocks, though the files are small.
TEST(Wiring, TheSizeOfADiagramIsBounded) {
  BlockLibrary blocks = small_library(), wires = small_library();
  for (int i = 0; i < 40; ++i) {
    const std::string name = "box" + std::to_string(i);
    const std::string inner = i == 0 ? "adder" : "box" + std::to_string(i - 1);
    const std::string ports = "[inputs]\nx = { sum = true }\n[outputs]\ny = { wire = \"s\" }\n[blocks]\n";
    blocks = with_box(ports + "s = { type = \"" + inner + "\", in = \"x\" }\nt = { type = \"" + inner +
                          "\", in = \"x\" }\n",
                      name, std::move(blocks));
    wires =
        with_box(ports + "s = { type = \"" + inner + "\", in = [\"x\", \"x\"] }\n", name, std::move(wires));
  }
  const std::string use = "a = { type = \"reference\" }\nc = { type = \"box39\", in = \"a\" }\n";
  EXPECT_EQ(
      wiring_message(use, blocks),
      "d.toml: the diagram has too many blocks; expected at most 300000, those inside composites counted");
  EXPECT_EQ(
      wiring_message(use, wires),
      "d.toml: the diagram has too many wires; expected at most 3000000, those inside composites counted");
}

}  // namespace
}  // namespace oblique::diagram
