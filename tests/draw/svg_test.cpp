// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/svg.h>
#include <oblique/draw/picture/text_width.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::draw {
namespace {

using ::testing::HasSubstr;

TEST(Svg, EscapesWhatXmlReserves) {
  EXPECT_EQ(escape_xml("a<b & \"c\" > 'd'\x01"), "a&lt;b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(escape_xml("\uFFFF\uFFFE\uFFFD"), "\uFFFD\uFFFD\uFFFD") << "XML 1.0, production 2";
}

TEST(Svg, WritesShortNumbers) {
  EXPECT_EQ(svg_number(0.125), "0.13");
  EXPECT_EQ(svg_number(-0.001), "0");
  EXPECT_EQ(svg_number(10), "10");
  EXPECT_EQ(svg_number(-2.5), "-2.5");
}

TEST(Svg, WritesEachKindOfMark) {
  Picture picture{100, 50, "A <title>", {}};
  picture.marks.push_back(line_mark({0, 0}, {10, 20.5}, {Ink::blue, 2, {4, 2}}));
  picture.marks.push_back(disc_mark({5, 6}, 3, Ink::paper));
  picture.marks.push_back(box_mark({1, 2}, {3, 4}, Ink::none));
  picture.marks.push_back(label_mark({7, 8}, "A & B", Anchor::middle));
  picture.marks.back().id = "name";
  const std::string svg = to_svg(picture);
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 100 50\""));
  EXPECT_THAT(svg, HasSubstr("<title>A &lt;title&gt;</title>"));
  EXPECT_THAT(
      svg, HasSubstr(
               R"(<path class="f-none s-blue" stroke-width="2" stroke-dasharray="4 2" d="M0 0 L10 20.5"/>)"));
  EXPECT_THAT(svg, HasSubstr(R"(<circle class="f-paper s-line" stroke-width="1.5" cx="5" cy="6" r="3"/>)"));
  EXPECT_THAT(
      svg, HasSubstr(R"(<rect class="f-none s-line" stroke-width="1.5" x="1" y="2" width="3" height="4"/>)"));
  EXPECT_THAT(
      svg,
      HasSubstr(
          R"(<text id="name" class="f-line s-none" x="7" y="8" font-size="12" text-anchor="middle">A &amp; B</text>)"));
  EXPECT_EQ(svg, to_svg(picture));
}

// DejaVu Sans's widths: A and V 684, space 318 thousandths.
TEST(Svg, SaysWhatMarksStandForWhereItIsAsked) {
  Picture picture{100, 50, "", {}};
  picture.marks.push_back(disc_mark({5, 6}, 3, Ink::paper));
  picture.marks.back().element = "q";
  picture.marks.back().signals = "q.x q.\"y\"";
  const std::string with_data = to_svg(picture, Theme::light, 1, true);
  EXPECT_THAT(with_data, HasSubstr(R"( data-element="q" data-signal="q.x q.&quot;y&quot;" cx="5")"));
  EXPECT_THAT(to_svg(picture, Theme::light), ::testing::Not(HasSubstr("data-")));
}

TEST(Picture, MeasuresTexts) {
  EXPECT_DOUBLE_EQ(text_width("A V", 10), 16.86);
  const auto extent = extent_of(label_mark({100, 100}, "A V", Anchor::end, 10));
  EXPECT_DOUBLE_EQ(extent.max().x(), 100);
  EXPECT_DOUBLE_EQ(extent.min().x(), 100 - 16.86);
  EXPECT_DOUBLE_EQ(text_width("°ωЖ", 10), 4.01 + 8.37 + 10.77);
  EXPECT_DOUBLE_EQ(text_width("\xC3", 10), 10);  // half a letter: the replacement character
}

}  // namespace
}  // namespace oblique::draw
