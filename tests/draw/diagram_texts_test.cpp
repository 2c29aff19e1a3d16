// SPDX-License-Identifier: MIT
// That no text of a block diagram lies on a line or on another text.
#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/draw/schematic/diagram_drawing.h>
#include <oblique/machine/realise.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/patch/patch.h>

#include "reading.h"

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

const std::filesystem::path kDiagrams = std::filesystem::path(OBLIQUE_SOURCE_DIR) / "diagrams";

const diagram::BlockLibrary& text_library() {
  static const diagram::BlockLibrary with_own = [] {
    diagram::BlockLibrary blocks = diagram::BlockLibrary::shipped();
    blocks.add_directory(kDiagrams / "own-blocks" / "blocks");
    return blocks;
  }();
  return with_own;
}

/// Diagrams with the names by which failures tell of them.
std::vector<std::pair<std::string, diagram::Diagram>> all_diagrams() {
  std::vector<std::pair<std::string, diagram::Diagram>> diagrams;
  std::vector<std::filesystem::path> paths;
  for (const char* const folder : {"lessons", "historical", "atlas", "own-blocks"}) {
    for (const auto& entry : std::filesystem::directory_iterator(kDiagrams / folder)) {
      if (entry.path().extension() == ".toml") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) diagrams.push_back({path.filename().string(), diagram::read_diagram(path)});
  const auto mechanism = [](const std::string& name) {
    return mechanism::read_mechanism(kDiagrams / "mechanisms" / (name + ".toml"));
  };
  diagrams.push_back({"patch of jansen", patch::patch_triangles(mechanism("jansen"))});
  diagrams.push_back({"patch of class-iii", patch::patch_triangles(mechanism("class-iii"))});
  diagrams.push_back({"patch of class-iii by paper", patch::patch_paper(mechanism("class-iii"))});
  const diagram::Diagram slider = patch::patch_triangles(mechanism("slider-crank"));
  diagrams.push_back({"patch of slider-crank for tr-10",
                      machine::realise(slider, text_library(), *diagram::find_machine("tr-10")).diagram});
  return diagrams;
}

/// Texts that lie on a line, slanted and round ones too, or on another text.
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
      const Mark& mark = picture.marks[k];
      if (k == i || !own.intersects(extent_of(mark))) continue;
      const auto* const other = std::get_if<Label>(&mark.shape);
      if (other != nullptr) {
        if (k < i) found.push_back(label->text + " on " + other->text);
      } else if (const auto* const box = std::get_if<Box>(&mark.shape)) {
        const Extent inside(box->corner, box->corner + box->size);
        if (!inside.contains(own)) found.push_back(label->text + " on the edge of " + mark.id);
      } else if (const auto* const disc = std::get_if<Disc>(&mark.shape)) {
        const Vector2d corner =
            (own.min() - disc->centre).cwiseAbs().cwiseMax((own.max() - disc->centre).cwiseAbs());
        if (own.exteriorDistance(disc->centre) < disc->radius && corner.norm() > disc->radius)
          found.push_back(label->text + " on a circle of " + mark.id);
      } else if (test::line_meets(mark, own)) {
        found.push_back(label->text + " on a line of " + mark.id);
      }
    }
  }
  return found;
}

TEST(DiagramTexts, AreClearOfMarksAndOfEachOther) {
  for (const auto& [name, diagram] : all_diagrams()) {
    for (const auto style : {SymbolStyle::classic, SymbolStyle::din}) {
      for (const int depth : {0, 1}) {
        const Picture picture = draw_diagram(diagram, text_library(), {style, depth});
        EXPECT_THAT(overlaps(picture), ::testing::IsEmpty())
            << name << ", depth " << depth << (style == SymbolStyle::din ? ", din" : "");
        for (const Mark& mark : picture.marks) {
          const Extent extent = extent_of(mark);
          EXPECT_TRUE(extent.min().minCoeff() >= 0 && extent.max().x() <= picture.width &&
                      extent.max().y() <= picture.height)
              << name << " " << mark.id;
        }
      }
    }
  }
}

// The check itself: a text on a slanted line is found, one beside it is not.
TEST(DiagramTexts, OverlapsAreFound) {
  Picture picture;
  picture.marks.push_back(line_mark({0, 0}, {100, 100}));
  picture.marks.push_back(label_mark({80, 40}, "beside"));
  EXPECT_THAT(overlaps(picture), ::testing::IsEmpty());
  picture.marks.push_back(label_mark({40, 60}, "on it"));
  EXPECT_THAT(overlaps(picture), ::testing::SizeIs(1));
}

}  // namespace
}  // namespace oblique::draw
