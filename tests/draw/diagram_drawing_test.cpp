// SPDX-License-Identifier: MIT
#include <oblique/draw/diagram_drawing.h>

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/draw/schematic.h>

namespace oblique {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;
using Extent = Eigen::AlignedBox<double, 2>;

const BlockLibrary& library() {
  static const BlockLibrary shipped = BlockLibrary::shipped();
  return shipped;
}

Diagram diagram(const std::string& blocks, const std::string& rest = "") {
  return parse_diagram("format = \"oblique-diagram/1\"\n" + rest + "[blocks]\n" + blocks, "test.toml");
}

const Mark* find_mark(const Picture& picture, const std::string& id) {
  for (const Mark& mark : picture.marks) {
    if (mark.id == id) return &mark;
  }
  return nullptr;
}

std::vector<std::string> texts(const Picture& picture) {
  std::vector<std::string> result;
  for (const Mark& mark : picture.marks) {
    if (const auto* const label = std::get_if<Label>(&mark.shape)) result.push_back(label->text);
  }
  return result;
}

std::vector<std::filesystem::path> shipped_diagrams() {
  std::vector<std::filesystem::path> paths;
  for (const char* const folder : {"lessons", "historical"}) {
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(OBLIQUE_SOURCE_DIR) /
                                                                 "diagrams" / folder)) {
      if (entry.path().extension() == ".toml") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// The straight lines of a mark that is no text; curves as the box around them is left out.
std::vector<Extent> lines_of(const Mark& mark) {
  std::vector<Extent> lines;
  const auto add = [&](const Vector2d& a, const Vector2d& b) {
    Extent extent(a);
    extent.extend(b);
    lines.push_back(extent);
  };
  if (mark.pen.ink == Ink::none) return lines;
  if (const auto* const outline = std::get_if<Outline>(&mark.shape)) {
    Vector2d at(0, 0);
    for (const Segment& s : outline->segments) {
      const bool straight = s.kind == Segment::Kind::line && (at.x() == s.to.x() || at.y() == s.to.y());
      if (straight) add(at, s.to);
      if (s.kind != Segment::Kind::close) at = s.to;
    }
  } else if (const auto* const box = std::get_if<Box>(&mark.shape)) {
    const Vector2d low = box->corner, high = box->corner + box->size;
    add(low, {high.x(), low.y()});
    add(low, {low.x(), high.y()});
    add({high.x(), low.y()}, high);
    add({low.x(), high.y()}, high);
  }
  return lines;
}

/// Texts that lie on a line or on another text.
std::vector<std::string> overlaps(const Picture& picture) {
  std::vector<std::string> found;
  constexpr double kTouch = 0.2;  // [px] that no one sees
  for (std::size_t i = 0; i < picture.marks.size(); ++i) {
    const auto* const label = std::get_if<Label>(&picture.marks[i].shape);
    if (label == nullptr) continue;
    Extent own = extent_of(picture.marks[i]);
    own.min() += Vector2d(kTouch, kTouch);
    own.max() -= Vector2d(kTouch, kTouch);
    for (std::size_t k = 0; k < picture.marks.size(); ++k) {
      if (k == i) continue;
      const auto* const other = std::get_if<Label>(&picture.marks[k].shape);
      if (other != nullptr && k < i && own.intersects(extent_of(picture.marks[k])))
        found.push_back(label->text + " on " + other->text);
      for (const Extent& line : lines_of(picture.marks[k])) {
        if (own.intersects(line)) found.push_back(label->text + " on a line of " + picture.marks[k].id);
      }
    }
  }
  return found;
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
  EXPECT_THAT(written, testing::Contains("a = −0.3"));
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
  const Diagram quotient = diagram(R"(
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
  const Diagram taken = diagram(R"(
drive = { type = "crank-generator" }
s     = { type = "summer", in = ["drive.excess"] }
)");
  for (const int depth : {0, 1}) {
    const Picture picture = draw_diagram(taken, library(), {SymbolStyle::classic, depth});
    EXPECT_NE(find_mark(picture, "net-drive.excess"), nullptr) << depth;
    EXPECT_THAT(texts(picture), testing::Contains("excess")) << depth;
  }
}

TEST(DiagramDrawing, DinSymbolsAreBoxes) {
  const Diagram sum = diagram("a = { type = \"summer\", in = [\"b\"] }\nb = { type = \"sine-source\" }\n");
  EXPECT_TRUE(std::holds_alternative<Outline>(find_mark(draw_diagram(sum, library()), "block-a")->shape));
  const Picture din = draw_diagram(sum, library(), {SymbolStyle::din, 0});
  EXPECT_TRUE(std::holds_alternative<Box>(find_mark(din, "block-a")->shape));
  EXPECT_THAT(texts(din), testing::Contains("Σ"));
}

TEST(DiagramDrawing, ReportsWhatIsWrongWithTheWiring) {
  try {
    draw_diagram(diagram("a = { type = \"summer\", in = [\"bb\"] }\n"), library());
    FAIL();
  } catch (const DiagramError& error) {
    EXPECT_THAT(to_string(error.diagnostics().front()), HasSubstr("there is no signal 'bb'"));
  }
}

TEST(DiagramDrawing, TextsAreClearOfMarksInTheShippedDiagrams) {
  for (const auto& path : shipped_diagrams()) {
    const Diagram shipped = read_diagram(path);
    for (const auto style : {SymbolStyle::classic, SymbolStyle::din}) {
      for (const int depth : {0, 1}) {
        const Picture picture = draw_diagram(shipped, library(), {style, depth});
        EXPECT_THAT(overlaps(picture), testing::IsEmpty()) << path << ", depth " << depth;
        for (const Mark& mark : picture.marks) {
          const Extent extent = extent_of(mark);
          EXPECT_TRUE(extent.min().minCoeff() >= 0 && extent.max().x() <= picture.width &&
                      extent.max().y() <= picture.height)
              << path << " " << mark.id;
        }
      }
    }
  }
}

}  // namespace
}  // namespace oblique
