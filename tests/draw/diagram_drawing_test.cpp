// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/diagram_drawing.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/draw/schematic/schematic.h>
#include <oblique/draw/schematic/symbols.h>

#include "reading.h"

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using test::find_mark;
using ::testing::HasSubstr;
using Extent = Eigen::AlignedBox<double, 2>;

const diagram::BlockLibrary& library() {
  static const diagram::BlockLibrary shipped = diagram::BlockLibrary::shipped();
  return shipped;
}

diagram::Diagram diagram(const std::string& blocks, const std::string& rest = "") {
  return diagram::parse_diagram("format = \"oblique-diagram/1\"\n" + rest + "[blocks]\n" + blocks,
                                "test.toml");
}

std::vector<std::string> texts(const Picture& picture) {
  std::vector<std::string> result;
  for (const Mark& mark : picture.marks) {
    if (const auto* const label = std::get_if<Label>(&mark.shape)) result.push_back(label->text);
  }
  return result;
}

// A circle of two integrators: initial values at the bars, the change of sign at the input.
TEST(DiagramDrawing, ShowsWeightsAndInitialValues) {
  const Picture picture = draw_diagram(diagram(R"(
x = { type = "integrator", in = ["-0.5*y"], initial = 0.25 }
y = { type = "integrator", in = ["x"] }
)"),
                                       library());
  const auto written = texts(picture);
  EXPECT_THAT(written, testing::IsSupersetOf({"x", "y", "−0.5", "0.25", "0"}));
  const Mark* const net = find_mark(picture, "net-x.out");
  ASSERT_NE(net, nullptr);
  const auto& wire = std::get<Outline>(net->shape);
  EXPECT_EQ(wire.segments.front().to.y(), wire.segments.back().to.y()) << "the wire forward is straight";
}

// Each composite holds the one before it twice: a drawing of 2⁴⁰ blocks, were it not counted first.
TEST(DiagramDrawing, IsNotOpenedBeyondAllMeasure) {
  diagram::BlockLibrary own = diagram::BlockLibrary::shipped();
  for (int k = 0; k < 40; ++k) {
    const std::string name = "c" + std::to_string(k);
    const std::string inside = k == 0 ? "inverter" : "c" + std::to_string(k - 1);
    own.add(
        diagram::parse_block("format = \"oblique-block/1\"\ntitle = \"c\"\n[inputs]\nin = { doc = \"d\" }\n"
                             "[outputs]\nout = { wire = \"j\", doc = \"d\" }\n[blocks]\n"
                             "i = { type = \"" +
                                 inside +
                                 "\", in = \"in\" }\n"
                                 "j = { type = \"" +
                                 inside + "\", in = \"i\" }\n",
                             name + ".toml", name));
  }
  const diagram::Diagram deep =
      diagram("one = { type = \"constant\" }\ne = { type = \"c39\", in = \"one\" }\n");
  EXPECT_THAT([&] { draw_diagram(deep, own, {.depth = 100}); },
              ::testing::ThrowsMessage<diagram::DiagramError>(
                  "test.toml: opened that far, the drawing has more than 30000 blocks\n"
                  "  remedy: open fewer levels of composites"));
  EXPECT_NO_THROW(draw_diagram(deep, own, {.depth = 3}));
}

TEST(DiagramDrawing, ConstantsStandWhereTheyAreUsed) {
  const Picture picture = draw_diagram(diagram(R"(
one = { type = "constant", value = 1 }
a   = { type = "constant", value = -0.3 }
s   = { type = "summer", in = ["one", "2*a"] }
t   = { type = "summer", in = ["one", "s"] }
)"),
                                       library());
  const auto written = texts(picture);
  EXPECT_EQ(std::count(written.begin(), written.end(), "+1"), 2);
  EXPECT_THAT(written, ::testing::Contains("a = −0.3"));
  EXPECT_EQ(find_mark(picture, "block-one"), nullptr);
}

TEST(DiagramDrawing, MarksWhatInverts) {
  const std::string blocks = "a = { type = \"summer\", in = [\"b\"] }\nb = { type = \"sine-source\" }\n";
  const auto circles = [](const Picture& picture) {
    return std::count_if(picture.marks.begin(), picture.marks.end(), [](const Mark& mark) {
      const auto* const disc = std::get_if<Disc>(&mark.shape);
      return disc != nullptr && disc->radius == 3;
    });
  };
  EXPECT_EQ(circles(draw_diagram(diagram(blocks), library())), 0);
  EXPECT_EQ(circles(draw_diagram(diagram(blocks, "[machine]\ninverting = true\n"), library())), 1);
  EXPECT_EQ(
      circles(draw_diagram(
          diagram("a = { type = \"inverter\", in = \"b\" }\nb = { type = \"sine-source\" }\n"), library())),
      1);
}

// c² = a² is tracked by c: the amplifier and the multiplier in its feedback have one colour, the other is
// black.
TEST(DiagramDrawing, GivesServoLoopsTheirColour) {
  const Picture picture = draw_diagram(diagram(R"(
a  = { type = "sine-source" }
a2 = { type = "multiplier", in = ["a", "a"] }
c2 = { type = "multiplier", in = ["c", "c"] }
c  = { type = "servo-amplifier", in = ["c2", "-a2"] }
)"),
                                       library());
  EXPECT_EQ(find_mark(picture, "block-c")->pen.ink, Ink::blue);
  EXPECT_EQ(find_mark(picture, "block-c2")->pen.ink, Ink::blue);
  EXPECT_EQ(find_mark(picture, "net-c.out")->pen.ink, Ink::blue);
  EXPECT_EQ(find_mark(picture, "net-c2.out")->pen.ink, Ink::blue);
  EXPECT_EQ(find_mark(picture, "block-a2")->pen.ink, Ink::line);
  EXPECT_EQ(find_mark(picture, "net-a2.out")->pen.ink, Ink::line);
}

TEST(DiagramDrawing, OpensCompositesToTheDepthAskedFor) {
  const diagram::Diagram quotient = diagram(R"(
a = { type = "sine-source" }
b = { type = "sine-source" }
q = { type = "divider", numerator = "a", denominator = "b" }
)");
  const Picture folded = draw_diagram(quotient, library());
  EXPECT_NE(find_mark(folded, "block-q"), nullptr);
  EXPECT_EQ(find_mark(folded, "block-q.product"), nullptr);
  const Picture open = draw_diagram(quotient, library(), {SymbolStyle::classic, 1});
  const Mark* const frame = find_mark(open, "block-q");
  const Mark* const product = find_mark(open, "block-q.product");
  ASSERT_NE(frame, nullptr);
  ASSERT_NE(product, nullptr);
  EXPECT_TRUE(extent_of(*frame).contains(extent_of(*product)));
  EXPECT_THAT(texts(open), testing::IsSupersetOf({"numerator", "denominator", "out"}));
}

// A signal inside a composite gets a port of its own.
TEST(DiagramDrawing, ShowsSignalsTakenFromInside) {
  const diagram::Diagram taken = diagram(R"(
drive = { type = "crank-generator" }
s     = { type = "summer", in = ["drive.excess"] }
)");
  for (const int depth : {0, 1}) {
    const Picture picture = draw_diagram(taken, library(), {SymbolStyle::classic, depth});
    EXPECT_NE(find_mark(picture, "net-drive.excess"), nullptr) << depth;
    EXPECT_THAT(texts(picture), ::testing::Contains("excess")) << depth;
  }
}

/// The signals of all marks that have some, by a word each.
std::vector<std::string> signals(const Picture& picture) {
  std::vector<std::string> found;
  for (const Mark& mark : picture.marks) {
    std::istringstream words(mark.signals);
    for (std::string word; words >> word;) found.push_back(word);
  }
  return found;
}

// Wires, leads and bodies say what a console reads there: behind a composite the inner block that it shows.
TEST(DiagramDrawing, NamesSignalsAsAConsoleDoes) {
  const diagram::Diagram quotient = diagram(R"(
k = { type = "constant", value = 0.25 }
a = { type = "sine-source" }
b = { type = "sine-source" }
r = { type = "resolver", length = "a", angle = "b" }
q = { type = "divider", numerator = "0.5*a", denominator = "b" }
s = { type = "summer", in = ["q", "k", "r.y"] }
)");
  const Picture folded = draw_diagram(quotient, library());
  EXPECT_EQ(find_mark(folded, "net-a.out")->signals, "a");
  EXPECT_EQ(find_mark(folded, "net-r.y")->signals, "r.y");
  EXPECT_EQ(find_mark(folded, "net-q.out")->signals, "q.quotient");
  EXPECT_EQ(find_mark(folded, "block-q")->signals, "q.quotient");
  EXPECT_EQ(find_mark(folded, "block-q")->element, "q");
  EXPECT_EQ(find_mark(folded, "block-r")->signals, "r.x r.y");
  EXPECT_THAT(signals(folded), testing::Contains("k")) << "the lead of a constant that stands at its input";
  // Inside, b arrives as it is; half of a is a signal that nothing gives.
  const Picture open = draw_diagram(quotient, library(), {SymbolStyle::classic, 1});
  EXPECT_EQ(find_mark(open, "net-q.denominator.denominator")->signals, "b");
  EXPECT_EQ(find_mark(open, "net-q.numerator.numerator")->signals, "");
  EXPECT_EQ(find_mark(open, "block-q.quotient")->element, "q.quotient");
}

// Every name is one of the flat diagram, and every signal of a wire that is not the sum at a composite's
// input has one.
TEST(DiagramDrawing, NamesSignalsThatThereAre) {
  std::size_t named = 0;
  for (const char* const folder : {"lessons", "historical"}) {
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(OBLIQUE_SOURCE_DIR) /
                                                                 "diagrams" / folder)) {
      if (entry.path().extension() != ".toml") continue;
      const diagram::Diagram shipped = diagram::read_diagram(entry.path());
      const diagram::FlatDiagram flat = diagram::flatten(shipped, library());
      std::set<std::string> known;
      for (std::size_t b = 0; b < flat.blocks.size(); ++b) {
        for (std::size_t k = 0; k < flat.blocks[b].definition->outputs.size(); ++k)
          known.insert(flat.signal_name({b, k}));
      }
      for (const int depth : {0, 1, 9}) {
        const Picture picture = draw_diagram(shipped, library(), {SymbolStyle::classic, depth});
        for (const std::string& signal : signals(picture)) {
          EXPECT_TRUE(known.contains(signal)) << entry.path() << ": " << signal;
          ++named;
        }
        for (const Mark& mark : picture.marks) {
          if (depth == 0 && (mark.id.starts_with("net-") || mark.id.starts_with("record-"))) {
            EXPECT_NE(mark.signals, "") << entry.path() << ": " << mark.id;
          }
        }
      }
    }
  }
  EXPECT_GT(named, 1000U);
}

TEST(DiagramDrawing, DinSymbolsAreBoxes) {
  const diagram::Diagram sum =
      diagram("a = { type = \"summer\", in = [\"b\"] }\nb = { type = \"sine-source\" }\n");
  EXPECT_TRUE(std::holds_alternative<Outline>(find_mark(draw_diagram(sum, library()), "block-a")->shape));
  const Picture din = draw_diagram(sum, library(), {SymbolStyle::din, 0});
  EXPECT_TRUE(std::holds_alternative<Box>(find_mark(din, "block-a")->shape));
  EXPECT_THAT(texts(din), ::testing::Contains("Σ"));
}

TEST(DiagramDrawing, ReportsWhatIsWrongWithTheWiring) {
  try {
    draw_diagram(diagram("a = { type = \"summer\", in = [\"bb\"] }\n"), library());
    FAIL();
  } catch (const diagram::DiagramError& error) {
    EXPECT_THAT(text::to_string(error.diagnostics().front()), HasSubstr("there is no signal 'bb'"));
  }
}

// What is measured is written at its signal, once for each, with its unit; the constant is not hidden at
// inputs.
TEST(DiagramDrawing, WritesWhatIsMeasured) {
  const Picture picture = draw_diagram(diagram(R"(
one = { type = "constant", value = 1 }
g   = { type = "crank-generator", speed = "one" }
s   = { type = "summer", in = ["g.cos", "g.sin", "one"] }
[outputs]
sum         = { signal = "s", scale = 2, unit = "m" }
"twice sum" = { signal = "s", scale = 4, unit = "cm" }
cosine      = "g.cos"
ratio       = { signal = "g.sin", unit = "1" }
reference   = "one"
surplus     = "g.excess"
)"),
                                       library());
  EXPECT_THAT(texts(picture),
              testing::IsSupersetOf({"sum [m], twice sum [cm]", "cosine", "ratio", "reference", "surplus"}));
  for (const char* const id : {"record-s", "record-g.cos", "record-g.sin", "record-one", "record-g.excess"})
    EXPECT_NE(find_mark(picture, id), nullptr) << id;
  const Extent arrow = extent_of(*find_mark(picture, "record-s")),
               block = extent_of(*find_mark(picture, "block-s"));
  EXPECT_GT(arrow.min().x(), block.max().x() - 1);
  EXPECT_NEAR(arrow.center().y(), block.center().y(), 1e-9);
  EXPECT_EQ(find_mark(picture, "record-g.cos")->fill, Ink::line);
}

TEST(DiagramDrawing, ReportsOutputsOfUnknownSignals) {
  try {
    draw_diagram(diagram("a = { type = \"sine-source\" }\n[outputs]\nx = \"b\"\n"), library());
    FAIL();
  } catch (const diagram::DiagramError& error) {
    EXPECT_THAT(error.what(), HasSubstr("output 'x': there is no signal 'b'"));
  }
}

// Circuits of one kind look alike, whichever of their inputs are used.
TEST(DiagramDrawing, OpenInputsOfCompositesShowTheirDefault) {
  const Picture picture = draw_diagram(
      diagram("a = { type = \"sine-source\" }\nd = { type = \"four-bar-circuit\", rocker = \"a\" }\n"),
      library());
  const auto written = texts(picture);
  EXPECT_EQ(std::count(written.begin(), written.end(), "0"), 4) << "px, py, qx and qy";
}

// Every kind of block has the sign of its kind: a curve, a text, or ports that mean something.
TEST(DiagramDrawing, EveryShippedBlockHasASymbol) {
  for (const std::string& name : library().names())
    EXPECT_NE(schematic::find_symbol(library().find(name)->symbol), nullptr) << name;
}

// S, R, Q and the inverted Q with its circle, after IEC 60617-12; J, K and the clock's wedge.
TEST(DiagramDrawing, FlipFlopsHaveTheSignsOfLogic) {
  const Picture picture = draw_diagram(diagram(R"(
s = { type = "sine-source" }
f = { type = "flip-flop", set = "s", reset = "s" }
j = { type = "jk-flip-flop", clock = "s", j = "s", k = "s", reset = "s" }
)"),
                                       library());
  const auto written = texts(picture);
  for (const auto& [sign, count] : {std::pair{"S", 1}, {"R", 2}, {"Q", 4}, {"J", 1}, {"K", 1}, {"C", 1}})
    EXPECT_EQ(std::count(written.begin(), written.end(), sign), count) << sign;
  const auto circles = std::count_if(picture.marks.begin(), picture.marks.end(), [](const Mark& mark) {
    const auto* const disc = std::get_if<Disc>(&mark.shape);
    return disc != nullptr && disc->radius == 3;
  });
  EXPECT_EQ(circles, 2);
}

// The number of an amplifier stands in its triangle, and its name below it; a label that is none takes the
// place of the name.
TEST(DiagramDrawing, WritesNumbersOfAmplifiersIntoThem) {
  for (const std::string number : {"9", "A0", "12"}) {
    const auto written = texts(draw_diagram(
        diagram("total = { type = \"summer\", in = [\"total\"], label = \"" + number + "\" }"), library()));
    EXPECT_THAT(written, testing::IsSupersetOf({number, std::string("total")})) << number;
  }
  const auto written = texts(
      draw_diagram(diagram("total = { type = \"summer\", in = [\"total\"], label = \"sum\" }"), library()));
  EXPECT_THAT(written, testing::Contains("sum"));
  EXPECT_THAT(written, testing::Not(testing::Contains("total")));
}

// A composite of a composite of two blocks gives what its innermost last block gives.
TEST(DiagramDrawing, NamesSignalsThatComeThroughTwoComposites) {
  diagram::BlockLibrary own = library();
  const std::string head = "format = \"oblique-block/1\"\ntitle = \"T\"\n[inputs]\nin = {}\n[outputs]\n";
  own.add(diagram::parse_block(head + R"(out = { wire = "second" }
[blocks]
first = { type = "inverter", in = "in" }
second = { type = "squarer", in = "first" }
)",
                               "inner.toml", "inner"));
  own.add(diagram::parse_block(head + R"(out = { wire = "deep.first" }
whole = { wire = "deep" }
[blocks]
deep = { type = "inner", in = "in" }
)",
                               "outer.toml", "outer"));
  const Picture picture = draw_diagram(diagram(R"(
a = { type = "sine-source" }
q = { type = "outer", in = "a" }
s = { type = "summer", in = ["q.out", "q.whole", "q.deep.first"] }
)"),
                                       own);
  EXPECT_EQ(find_mark(picture, "net-q.out")->signals, "q.deep.first");
  EXPECT_EQ(find_mark(picture, "net-q.whole")->signals, "q.deep.second");
}

}  // namespace
}  // namespace oblique::draw
