// SPDX-License-Identifier: MIT
// Where the blocks of a diagram stand: as its [layout] says, or alike where they are alike.
#include <oblique/draw/schematic/diagram_drawing.h>

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/patch/patch.h>

#include "reading.h"

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using test::find_mark;
using ::testing::HasSubstr;

constexpr double kUnit = 16;           // of a [layout] [px]
constexpr double kLayoutRounding = 4;  // boxes stand on a grid of 8 px: half of it [px]

const diagram::BlockLibrary& layout_library() {
  static const diagram::BlockLibrary shipped = diagram::BlockLibrary::shipped();
  return shipped;
}

diagram::Diagram diagram_of(const std::string& text) {
  return diagram::parse_diagram("format = \"oblique-diagram/1\"\n" + text, "test.toml");
}

std::string message_of(const std::string& text) {
  try {
    draw_diagram(diagram_of(text), layout_library());
  } catch (const diagram::DiagramError& error) {
    return error.what();
  }
  return "no error";
}

Vector2d middle(const Picture& picture, const std::string& id) {
  const Mark* const mark = find_mark(picture, id);
  EXPECT_NE(mark, nullptr) << id;
  return mark == nullptr ? Vector2d(0, 0) : Vector2d(extent_of(*mark).center());
}

const std::string kPair = R"([blocks]
a = { type = "sine-source" }
b = { type = "multiplier", x = "a", y = "c" }
c = { type = "divider", numerator = "b", denominator = "a" }
)";

TEST(DiagramLayout, BlocksStandWhereTheFileSays) {
  const Picture picture = draw_diagram(
      diagram_of(kPair + "[layout]\na = [4, 20]\nb = [14, 8.5]\nc = [30, 8.5]\n"), layout_library());
  const Vector2d a = middle(picture, "block-a"), b = middle(picture, "block-b"),
                 c = middle(picture, "block-c");
  EXPECT_EQ(b - a, kUnit * Vector2d(10, -11.5));
  EXPECT_EQ(c - b, kUnit * Vector2d(16, 0));
}

TEST(DiagramLayout, PlacesAreRoundedToHalfAUnit) {
  const Picture picture = draw_diagram(
      diagram_of(kPair + "[layout]\na = [4, 20]\nb = [14.1, 8.4]\nc = [30, 8.5]\n"), layout_library());
  EXPECT_EQ(middle(picture, "block-b") - middle(picture, "block-a"), kUnit * Vector2d(10, -11.5));
}

// Opening c makes room for its frame: b keeps its side.
TEST(DiagramLayout, OpenCompositesPushTheOthersAway) {
  const diagram::Diagram placed = diagram_of(kPair + "[layout]\na = [4, 20]\nb = [14, 8.5]\nc = [30, 8.5]\n");
  const Picture picture = draw_diagram(placed, layout_library(), {SymbolStyle::classic, 1});
  const auto extent = [&](const std::string& id) { return extent_of(*find_mark(picture, id)); };
  EXPECT_LT(extent("block-b").max().x(), extent("block-c").min().x());
  EXPECT_LT(extent("block-a").max().x(), extent("block-b").min().x());
  EXPECT_NEAR(middle(picture, "block-b").y(), middle(picture, "block-c").y(), kLayoutRounding);
}

TEST(DiagramLayout, RefusesBlocksOverEachOther) {
  EXPECT_EQ(
      message_of(kPair + "[layout]\na = [4, 20]\nb = [14, 8.5]\nc = [15, 9]\n"),
      "test.toml:9:1: 'c' overlaps 'b' or is too close to it in [layout]; expected blocks apart from each "
      "other: 'c' with its texts takes 7.5 by 4\n  remedy: move it by 4 down");
  EXPECT_EQ(
      message_of(kPair + "[layout]\na = [4, 20]\nb = [14, 8.5]\nc = [14, 12]\n"),
      "test.toml:9:1: 'c' overlaps 'b' or is too close to it in [layout]; expected blocks apart from each "
      "other: 'c' with its texts takes 7.5 by 4\n  remedy: move it by 1 down");
}

TEST(DiagramLayout, TheRemedyAgainstOverlapsHelps) {
  EXPECT_EQ(message_of(kPair + "[layout]\na = [4, 20]\nb = [14, 8.5]\nc = [14, 13]\n"), "no error");
}

// Two blocks so close together that the many wires between them have no room.
TEST(DiagramLayout, SaysWhichWiresFindNoWay) {
  std::string blocks = "[blocks]\ns = { type = \"sine-source\" }\n", layout = "[layout]\n";
  for (int k = 0; k < 12; ++k) {
    const std::string name = "f" + std::to_string(k);
    blocks += name + " = { type = \"four-bar-circuit\", px = \"f" + std::to_string((k + 1) % 12) +
              ".x\", py = \"f" + std::to_string((k + 2) % 12) + ".y\", qx = \"f" +
              std::to_string((k + 5) % 12) + ".sin_alpha\", qy = \"f" + std::to_string((k + 7) % 12) +
              ".cos_psi\", rocker = \"f" + std::to_string((k + 9) % 12) + ".diagonal\" }\n";
    layout += name + " = [" + std::to_string(10.5 * (k % 4)) + ", " + std::to_string(13 * (k / 4)) + "]\n";
  }
  EXPECT_THAT(message_of(blocks + layout),
              HasSubstr("find no way among the places of [layout]; expected room for "
                        "wires between blocks\n  remedy: move 'f"));
}

std::vector<std::filesystem::path> shipped_diagrams() {
  std::vector<std::filesystem::path> paths;
  for (const char* const folder : {"lessons", "historical"}) {
    const auto path = std::filesystem::path(OBLIQUE_SOURCE_DIR) / "diagrams" / folder;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (entry.path().extension() == ".toml") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

// By way of the file, as a user has it; a shift of the whole is none.
TEST(DiagramLayout, TheDrawnPlacesGiveThemselves) {
  for (const auto& path : shipped_diagrams()) {
    diagram::Diagram shipped = diagram::read_diagram(path);
    const std::vector<diagram::BlockPlace> places = drawn_places(shipped, layout_library());
    shipped.layout = places;
    const diagram::Diagram written = diagram::parse_diagram(diagram::write_diagram(shipped), "written.toml");
    const std::vector<diagram::BlockPlace> again = drawn_places(written, layout_library());
    ASSERT_EQ(again.size(), places.size());
    const Vector2d shift(again[0].x - places[0].x, again[0].y - places[0].y);
    for (std::size_t k = 0; k < places.size(); ++k) {
      EXPECT_EQ(again[k].name, places[k].name);
      EXPECT_EQ(Vector2d(again[k].x, again[k].y) - shift, Vector2d(places[k].x, places[k].y))
          << path << " " << places[k].name;
    }
  }
}

TEST(DiagramLayout, ABlockFileMayPlaceItsInnerBlocks) {
  diagram::BlockLibrary own = layout_library();
  own.add(diagram::parse_block(R"(format = "oblique-block/1"
title = "Difference of squares"
[inputs]
p = {}
q = {}
[outputs]
out = { wire = "sum" }
[blocks]
p2  = { type = "squarer", in = "p" }
q2  = { type = "squarer", in = "q" }
sum = { type = "summer", in = ["p2", "-q2"] }
[layout]
p2  = [4, 4]
q2  = [4, 20]
sum = [16, 12]
)",
                               "own.toml", "own"));
  const diagram::Diagram uses =
      diagram_of("[blocks]\ns = { type = \"sine-source\" }\na = { type = \"own\", p = \"s\", q = \"s\" }\n");
  const Picture picture = draw_diagram(uses, own, {SymbolStyle::classic, 1});
  EXPECT_EQ(middle(picture, "block-a.q2") - middle(picture, "block-a.p2"), kUnit * Vector2d(0, 16));
  const Vector2d sum = middle(picture, "block-a.sum") - middle(picture, "block-a.p2");
  EXPECT_LE((sum - kUnit * Vector2d(12, 8)).lpNorm<Eigen::Infinity>(), kLayoutRounding);
}

/// The marks whose ids start so, without that start, in the picture's order.
std::vector<std::pair<std::string, Mark>> marks_of(const Picture& picture, const std::string& start) {
  std::vector<std::pair<std::string, Mark>> marks;
  for (const Mark& mark : picture.marks) {
    for (const std::string kind : {"block-", "net-"}) {
      // the nets of the frame itself lie outside it
      const bool inside = kind == "block-" || std::count(mark.id.begin(), mark.id.end(), '.') > 1;
      if (inside && mark.id.starts_with(kind + start))
        marks.push_back({kind + mark.id.substr(kind.size() + start.size()), mark});
    }
  }
  return marks;
}

// The source's fig. 2: the model of a class III mechanism is two equal circuits. Each line and each block of
// the one lies where it lies in the other, apart from one shift.
TEST(DiagramLayout, AClassThreeMechanismIsTwoEqualHalves) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(std::filesystem::path(OBLIQUE_SOURCE_DIR) /
                                                                   "diagrams/mechanisms/class-iii.toml");
  const diagram::Diagram patched = patch::patch_paper(mechanism);
  std::vector<std::string> halves;
  for (const diagram::BlockInstance& block : patched.blocks) {
    if (block.type == "four-bar-circuit") halves.push_back(block.name);
  }
  ASSERT_EQ(halves.size(), 2U);
  for (const SymbolStyle style : {SymbolStyle::classic, SymbolStyle::din}) {
    const Picture picture = draw_diagram(patched, layout_library(), {style, 1});
    const auto one = marks_of(picture, halves[0] + "."), two = marks_of(picture, halves[1] + ".");
    ASSERT_EQ(one.size(), two.size());
    EXPECT_GT(one.size(), 40U) << "blocks and wires of a circuit";
    const Vector2d shift = extent_of(two[0].second).min() - extent_of(one[0].second).min();
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_EQ(one[k].first, two[k].first);
      const auto a = extent_of(one[k].second), b = extent_of(two[k].second);
      // sums of coordinates in multiples of 1/2 px: exact but for the title's width
      EXPECT_LT((b.min() - a.min() - shift).norm(), 1e-9) << one[k].first;
      EXPECT_LT((b.max() - a.max() - shift).norm(), 1e-9) << one[k].first;
    }
    const auto frame = extent_of(*find_mark(picture, "block-" + halves[0]));
    EXPECT_FALSE(frame.intersects(extent_of(*find_mark(picture, "block-" + halves[1]))));
  }
}

}  // namespace
}  // namespace oblique::draw
