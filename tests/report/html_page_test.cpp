// SPDX-License-Identifier: MIT
#include <oblique/report/html_page.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(HtmlPage, ListsItsSectionsAndLeadsToThem) {
  HtmlPage page("A & B");
  page.heading("First < second");
  page.subheading("no section");
  page.heading("Last");
  const std::string text = page.text(draw::Theme::automatic);
  EXPECT_THAT(text, HasSubstr("<title>A &amp; B</title>"));
  EXPECT_THAT(text, HasSubstr("<nav><ul>\n<li><a href=\"#section-1\">First &lt; second</a></li>\n"
                              "<li><a href=\"#section-2\">Last</a></li>\n</ul></nav>"));
  EXPECT_THAT(text, HasSubstr("<h2 id=\"section-1\">First &lt; second</h2>"));
  EXPECT_THAT(text, HasSubstr("<h2 id=\"section-2\">Last</h2>"));
}

TEST(HtmlPage, EscapesEveryText) {
  HtmlPage page("page");
  page.paragraph("a < b");
  page.introduction("b < c");
  page.list({"c < d"});
  page.table({"d < e"}, {{"e < f"}});
  for (const char* const text : {"<p>a &lt; b</p>", "<p class=\"lead\">b &lt; c</p>", "<li>c &lt; d</li>",
                                 "<th>d &lt; e</th>", "<td>e &lt; f</td>"})
    EXPECT_THAT(page.text(draw::Theme::light), HasSubstr(text));
}

TEST(HtmlPage, ShowsWhatStandsInBackticksAsCode) {
  HtmlPage page("page");
  page.paragraph("`a < b` and `c`, not ` alone");
  page.introduction("`d`");
  page.list({"e `f`"});
  for (const char* const text : {"<p><code>a &lt; b</code> and <code>c</code>, not ` alone</p>",
                                 "<p class=\"lead\"><code>d</code></p>", "<li>e <code>f</code></li>"})
    EXPECT_THAT(page.text(draw::Theme::light), HasSubstr(text));
}

// On a narrow window they keep a width at which they can be read, and are scrolled.
TEST(HtmlPage, GivesBroadPicturesTheWidthOfTheWindow) {
  HtmlPage page("page");
  page.picture({1000, 30, "broad", {}});
  page.picture({900, 30, "not", {}});
  const std::string text = page.text(draw::Theme::light);
  EXPECT_THAT(text, HasSubstr("<figure class=\"broad\"><div style=\"min-width: 500px\"><svg "
                              "xmlns=\"http://www.w3.org/2000/svg\" width=\"1000\""));
  EXPECT_THAT(text, HasSubstr("<figure><svg xmlns=\"http://www.w3.org/2000/svg\" width=\"900\""));
  EXPECT_THAT(text, HasSubstr("figure.broad { margin-inline: calc(50% - 50vw + 1rem);"));
}

TEST(HtmlPage, PutsColumnsOfNumbersToTheRight) {
  HtmlPage page("page");
  page.table({{"name", "size", "mixed"}, {"a", "-1.5e-3", "2"}, {"b", "4", "two"}});
  EXPECT_THAT(page.text(draw::Theme::light),
              HasSubstr("<tr><th>name</th><th class=\"n\">size</th><th>mixed</th></tr>"));
  EXPECT_THAT(page.text(draw::Theme::light),
              HasSubstr("<tr><td>b</td><td class=\"n\">4</td><td>two</td></tr>"));
}

TEST(HtmlPage, LeadsFromTheRowsOfATable) {
  HtmlPage page("page");
  page.table({"name", "size"}, {{"a < b", "1"}, {"c", "2"}}, {"a.html?x&y", ""});
  EXPECT_THAT(page.text(draw::Theme::light),
              HasSubstr("<tr><td><a href=\"a.html?x&amp;y\">a &lt; b</a></td><td class=\"n\">1</td></tr>\n"
                        "<tr><td>c</td><td class=\"n\">2</td></tr>"));
}

TEST(HtmlPage, HasPicturesWithoutIdsAndIsLightOnPaper) {
  draw::Picture picture{40, 30, "a disc", {draw::disc_mark({20, 15}, 5, draw::Ink::blue)}};
  picture.marks.front().id = "disc";
  HtmlPage page("page");
  page.picture(picture);
  page.picture(picture);
  const std::string dark = page.text(draw::Theme::dark);
  EXPECT_THAT(dark, HasSubstr("viewBox=\"0 0 40 30\" role=\"img\">\n<title>a disc</title>"));
  EXPECT_THAT(dark, Not(HasSubstr("id=\"disc\"")));
  const std::string print = dark.substr(dark.find("@media print"));
  EXPECT_THAT(print, HasSubstr(draw::svg_style(draw::Theme::light)));
  EXPECT_THAT(dark.substr(0, dark.find("@media print")), HasSubstr(draw::svg_style(draw::Theme::dark)));
}

}  // namespace
}  // namespace oblique::report
