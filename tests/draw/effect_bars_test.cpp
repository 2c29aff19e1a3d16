// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/effect_bars.h>

#include <gtest/gtest.h>

namespace oblique::draw {
namespace {

Box bar_of(const Picture& picture, const std::string& id) {
  for (const Mark& mark : picture.marks) {
    if (mark.id == id) return std::get<Box>(mark.shape);
  }
  ADD_FAILURE() << id;
  return {};
}

TEST(EffectBars, AreAsLongAsTheirEffects) {
  const EffectBars panel{
      {"mean"}, 5, {{"length", 1, 9, "0.8", "1.2"}, {"gain", 4, 6, "1e6", "1e3"}, {"none", 5, 5, "1", "2"}}};
  const Picture picture = draw_effect_bars("Title", {panel}, "");
  const Box length = bar_of(picture, "bar-0-0"), gain = bar_of(picture, "bar-0-1"),
            none = bar_of(picture, "bar-0-2");
  EXPECT_NEAR(length.size.x(), 4 * gain.size.x(), 1e-9);
  EXPECT_EQ(none.size.x(), 1);  // to be seen at all [px]
  EXPECT_NEAR(length.corner.x() + length.size.x() / 2, gain.corner.x() + gain.size.x() / 2, 1e-9);
  EXPECT_LT(length.corner.y() + length.size.y(), gain.corner.y());
}

// Texts keep off the bars and within the picture.
TEST(EffectBars, HaveRoomForTheirTexts) {
  const EffectBars panel{{"rank correlation with max(abs(side - exact))"},
                         0,
                         {{"a.rather.long.name.of.a.parameter", -1, 0, "", ""}, {"b", 0, 0.5, "", ""}}};
  const Picture picture = draw_effect_bars("", {panel, panel}, "2 of 9 machines failed and are not drawn.");
  const Box bar = bar_of(picture, "bar-0-0");
  for (const Mark& mark : picture.marks) {
    const auto extent = extent_of(mark);
    EXPECT_GE(extent.min().minCoeff(), 0);
    EXPECT_LE(extent.max().x(), picture.width);
    EXPECT_LE(extent.max().y(), picture.height);
    const Label* const label = std::get_if<Label>(&mark.shape);
    if (label != nullptr && label->text.starts_with("a.rather")) {
      EXPECT_LT(extent.max().x(), bar.corner.x());
    }
  }
}

}  // namespace
}  // namespace oblique::draw
