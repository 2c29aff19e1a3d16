// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/panel.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>

#include "reading.h"

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Rectangle = Eigen::AlignedBox<double, 2>;

const diagram::BlockLibrary& panel_library() {
  static const diagram::BlockLibrary shipped = diagram::BlockLibrary::shipped();
  return shipped;
}

const std::string panel_head = "format = \"oblique-diagram/1\"\n[blocks]\n";

/// A diagram that may be wrong; a panel points into it.
diagram::Diagram sketched(const std::string& text) {
  text::Diagnostics ignored;
  return diagram::parse_diagram(text, "x.toml", ignored);
}

const PatchPanelBlock& block(const PatchPanel& panel, const std::string& name) {
  return *std::find_if(panel.blocks.begin(), panel.blocks.end(),
                       [&](const PatchPanelBlock& one) { return one.instance->name == name; });
}

Rectangle rectangle(const Box& box) {
  return {box.corner, box.corner + box.size};
}

TEST(PatchPanel, TellsWhereEverythingIs) {
  const diagram::Diagram diagram = diagram::read_diagram(std::filesystem::path(OBLIQUE_SOURCE_DIR) /
                                                         "diagrams/lessons/triangle-side.toml");
  const PatchPanel panel = draw_panel(diagram, panel_library());
  ASSERT_EQ(panel.blocks.size(), diagram.blocks.size());
  EXPECT_TRUE(panel.moved.empty());
  EXPECT_TRUE(panel.lost.empty());
  for (const PatchPanelBlock& one : panel.blocks) {
    SCOPED_TRACE(one.instance->name);
    EXPECT_EQ(one.body.has_value(), one.definition->name != "constant");  // those stand at inputs
    if (!one.body) continue;
    const Mark* const mark = test::find_mark(panel.picture, "block-" + one.instance->name);
    ASSERT_NE(mark, nullptr);
    // the outline with its pen; a round back bulges a little, and the triangle of an integrator stands 6 px
    // to the right of the middle, beside its bar
    EXPECT_LT((extent_of(*mark).center() - rectangle(*one.body).center()).norm(), 7);
    EXPECT_TRUE(one.open_inputs.empty());
    for (const PatchPanelWire& wire : one.wires) {
      ASSERT_TRUE(wire.at) << wire.written.text;
      EXPECT_EQ(wire.at->x(), one.body->corner.x());
      const Mark* const net = test::find_mark(panel.picture, "net-" + wire.written.signal + ".out");
      if (net == nullptr) continue;  // a constant
      EXPECT_TRUE(test::line_meets(*net, {Vector2d(one.whole->corner.x() - 1, wire.at->y() - 1),
                                          Vector2d(one.whole->corner.x() + 1, wire.at->y() + 1)}))
          << wire.written.text;
    }
    for (const PatchPanelPort& output : one.outputs) {
      EXPECT_EQ(output.name, one.instance->name);
      EXPECT_EQ(output.at.x(), one.body->corner.x() + one.body->size.x());
    }
  }
  const PatchPanelBlock& amplifier = block(panel, "c");
  ASSERT_EQ(amplifier.wires.size(), 4U);
  EXPECT_EQ(amplifier.wires[3].weight, 2);
  EXPECT_EQ(amplifier.wires[3].written.term, 3U);
  EXPECT_EQ(amplifier.wires[1].weight, -1);
}

TEST(PatchPanel, GivesPlacesThatDrawTheSame) {
  const std::string text =
      panel_head +
      "a = { type = \"constant\", value = 0.5 }\nx = { type = \"integrator\", in = [\"a\", "
      "\"-y\"] }\ny = { type = \"integrator\", in = \"x\" }\n";
  const diagram::Diagram free = sketched(text);
  const PatchPanel before = draw_panel(free, panel_library());
  std::string layout = "\n[layout]\n";
  for (const PatchPanelBlock& one : before.blocks) {
    EXPECT_FALSE(one.is_placed);
    if (one.body)
      layout += one.instance->name + " = [" + std::to_string(one.x) + ", " + std::to_string(one.y) + "]\n";
  }
  const diagram::Diagram placed = sketched(text + layout);
  const PatchPanel after = draw_panel(placed, panel_library());
  for (std::size_t b = 0; b < before.blocks.size(); ++b) {
    if (!before.blocks[b].body) continue;
    EXPECT_TRUE(after.blocks[b].is_placed);
    EXPECT_EQ(after.blocks[b].x, before.blocks[b].x);
    EXPECT_EQ((before.blocks[b].body->corner - before.origin), (after.blocks[b].body->corner - after.origin));
  }
}

TEST(PatchPanel, ShowsWhatIsMissing) {
  const diagram::Diagram diagram =
      sketched(panel_head +
               "m = { type = \"multiplier\", in = [\"nobody\"] }\nx = { type = "
               "\"integrator\" }\nw = { type = \"integrater\", in = [\"x\", \"m\"], gain = 3 }\n"
               "z = { type = \"integrator\", in = \"w\" }\nn = { }\n");
  const PatchPanel panel = draw_panel(diagram, panel_library());
  EXPECT_FALSE(block(panel, "m").wires.at(0).at);  // there is no 'nobody'
  ASSERT_EQ(block(panel, "m").open_inputs.size(), 2U);
  EXPECT_EQ(block(panel, "m").open_inputs[0].name, "x");
  EXPECT_EQ(block(panel, "x").open_inputs.at(0).name, "in");
  const PatchPanelBlock& unknown = block(panel, "w");
  EXPECT_EQ(unknown.definition, nullptr);
  ASSERT_EQ(unknown.wires.size(), 2U);
  EXPECT_TRUE(unknown.wires[0].at);
  EXPECT_TRUE(unknown.wires[1].at);
  EXPECT_TRUE(block(panel, "z").wires.at(0).at);
  EXPECT_TRUE(block(panel, "n").body);
}

TEST(PatchPanel, KeepsBlocksApart) {
  const std::string text =
      panel_head +
      "x = { type = \"integrator\", in = \"z\" }\ny = { type = \"integrator\", in = \"x\" }\n"
      "z = { type = \"integrator\", in = \"y\" }\n\n[layout]\n";
  const diagram::Diagram diagram = sketched(text + "x = [10, 10]\ny = [10, 10.5]\nz = [11, 9]\n");
  EXPECT_THROW(draw_diagram(diagram, panel_library()), diagram::DiagramError);
  const PatchPanel panel = draw_panel(diagram, panel_library(), "x");
  ASSERT_EQ(panel.moved.size(), 2U);  // y stays: it stands first in the table, but for the one that is held
  std::string layout = text + "y = [10, 10.5]\n";
  for (const diagram::BlockPlace& place : panel.moved) {
    EXPECT_NE(place.name, "y");
    // no further than three of these blocks
    EXPECT_LT(Vector2d(place.x - 10, place.y - 10).norm(), 18);
    layout += place.name + " = [" + std::to_string(place.x) + ", " + std::to_string(place.y) + "]\n";
  }
  EXPECT_NO_THROW(draw_diagram(sketched(layout), panel_library()));
}

TEST(PatchPanel, LeavesConstantsWhereTheyWerePut) {
  const std::string text =
      panel_head +
      "a = { type = \"constant\" }\nx = { type = \"integrator\", in = \"a\" }\n\n[layout]\nx = [10, 4]\n";
  const diagram::Diagram at_input = sketched(text), apart = sketched(text + "a = [2, 4]\n");
  EXPECT_FALSE(block(draw_panel(at_input, panel_library()), "a").body);
  const PatchPanel panel = draw_panel(apart, panel_library());
  ASSERT_TRUE(block(panel, "a").body);
  EXPECT_LT(block(panel, "a").body->corner.x(), block(panel, "x").body->corner.x());
}

TEST(PatchPanel, DrawsNothingOfAnEmptyDiagram) {
  const diagram::Diagram empty = sketched(panel_head);
  const PatchPanel panel = draw_panel(empty, panel_library());
  EXPECT_TRUE(panel.blocks.empty());
  EXPECT_GT(panel.picture.width, 0);
}

TEST(PatchPanel, OpensOneComposite) {
  const diagram::Diagram diagram = diagram::parse_diagram(
      panel_head +
          "a = { type = \"constant\" }\nq = { type = \"divider\", numerator = \"a\", denominator = \"a\" }\n",
      "x.toml");
  const Picture inside = draw_inside(diagram, panel_library(), "q");
  EXPECT_NE(test::find_mark(inside, "block-product"), nullptr);
  EXPECT_EQ(test::find_mark(inside, "block-q"), nullptr);
  try {
    draw_inside(diagram, panel_library(), "q.product");
    FAIL();
  } catch (const diagram::DiagramError& error) {
    EXPECT_STREQ(
        error.what(),
        "x.toml: there is no composite 'q.product' to be opened; expected the path of a block that is put "
        "together of others");
  }
}

TEST(PatchPanel, DrawsTheSymbolOfEveryKind) {
  for (const std::string& name : panel_library().names()) {
    const Picture picture = draw_symbol_of(*panel_library().find(name));
    EXPECT_FALSE(picture.marks.empty()) << name;
    for (const Mark& mark : picture.marks) {
      const Rectangle extent = extent_of(mark);
      EXPECT_TRUE(
          Rectangle(Vector2d(-1, -1), Vector2d(picture.width + 1, picture.height + 1)).contains(extent))
          << name;
    }
  }
}

// Twelve circuits so near to each other that some wires find no way: they are drawn straight and dashed, in
// red, from the output to the input.
TEST(PatchPanel, DrawsWiresThatFindNoWayStraight) {
  std::string blocks = panel_head + "s = { type = \"sine-source\" }\n", layout = "[layout]\n";
  const auto circuit = [](int k) { return "f" + std::to_string(k % 12); };
  for (int k = 0; k < 12; ++k) {
    blocks += circuit(k) + " = { type = \"four-bar-circuit\", px = \"" + circuit(k + 1) + ".x\", py = \"" +
              circuit(k + 2) + ".y\", qx = \"" + circuit(k + 5) + ".sin_alpha\", qy = \"" + circuit(k + 7) +
              ".cos_psi\", rocker = \"" + circuit(k + 9) + ".diagonal\" }\n";
    layout +=
        circuit(k) + " = [" + std::to_string(10.5 * (k % 4)) + ", " + std::to_string(13 * (k / 4)) + "]\n";
  }
  const diagram::Diagram diagram = sketched(blocks + layout);
  const PatchPanel panel = draw_panel(diagram, panel_library());
  EXPECT_FALSE(panel.lost.empty());
  std::size_t straight = 0;
  for (const Mark& mark : panel.picture.marks) {
    const auto* const outline = std::get_if<Outline>(&mark.shape);
    if (outline == nullptr || mark.pen.ink != Ink::vermilion || mark.pen.dashes.empty()) continue;
    EXPECT_EQ(mark.pen.dashes, (std::vector<double>{4, 3}));
    const Vector2d end = outline->segments.back().to;
    EXPECT_TRUE(std::any_of(panel.blocks.begin(), panel.blocks.end(), [&](const PatchPanelBlock& one) {
      return std::any_of(one.wires.begin(), one.wires.end(), [&](const PatchPanelWire& wire) {
        // a wire ends at the box of the layout, before the body
        return wire.at && std::abs(wire.at->y() - end.y()) < 1e-9 && end.x() <= wire.at->x() &&
               end.x() > wire.at->x() - 40;
      });
    })) << end.transpose();
    ++straight;
  }
  EXPECT_GE(straight, panel.lost.size());
}

}  // namespace
}  // namespace oblique::draw
