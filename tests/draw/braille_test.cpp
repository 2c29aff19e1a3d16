// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/braille.h>

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::draw {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::u32string> lines_of(const std::string& text) {
  std::vector<std::u32string> lines(1);
  for (std::size_t k = 0; k < text.size();) {
    const auto byte = static_cast<unsigned char>(text[k]);
    const std::size_t length = byte < 0x80 ? 1 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4;
    char32_t letter = length == 1 ? byte : byte & (0xFFU >> (length + 1));
    for (std::size_t more = 1; more < length; ++more)
      letter = letter << 6U | (static_cast<unsigned char>(text[k + more]) & 0x3FU);
    if (letter == U'\n') {
      lines.emplace_back();
    } else {
      lines.back() += letter;
    }
    k += length;
  }
  return lines;
}

bool is_dots(char32_t letter) {
  return letter >= 0x2800 && letter <= 0x28FF;
}

Chart ramp() {
  return {"", {{{"t", "s"}, {"", "m"}, {{"up", {{0, 0}, {1, 1}}}, {"down", {{0, 1}, {1, 0}}, 1}}}}};
}

// A line from corner to corner has as many dots to the left of every row as to the right of the row that lies
// as far from the other end.
TEST(Braille, DrawsALineFromCornerToCorner) {
  Chart chart = ramp();
  chart.panels[0].curves.pop_back();
  const auto lines = lines_of(to_braille(chart, 60, false));
  std::vector<std::size_t> first;
  for (const auto& line : lines) {
    const auto found = std::find_if(line.begin(), line.end(), is_dots);
    if (found != line.end()) first.push_back(static_cast<std::size_t>(found - line.begin()));
  }
  ASSERT_EQ(first.size(), 13U);  // rows of a panel of 220 px
  EXPECT_TRUE(std::is_sorted(first.rbegin(), first.rend()));
  for (std::size_t r = 1; r < first.size(); ++r)
    EXPECT_NEAR(static_cast<double>(first[r - 1] - first[r]), 51.0 / 13, 1.1);
}

TEST(Braille, NamesCurvesAtTheirEndsAndNumbersTheAxes) {
  const std::string text = to_braille(ramp(), 70, false);
  EXPECT_THAT(text, HasSubstr("[m]\n"));
  EXPECT_THAT(text, HasSubstr("1.0 ┤"));
  EXPECT_THAT(text, HasSubstr("t [s]\n"));
  EXPECT_THAT(text, Not(HasSubstr("\033")));
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);  // [m]
  std::getline(stream, line);  // the uppermost row, where `up` ends
  EXPECT_TRUE(line.ends_with(" up")) << line;
}

TEST(Braille, PutsTheTitleOfTheAxisUnderItsMiddle) {
  const auto lines = lines_of(to_braille(ramp(), 70, false));
  const auto axis = std::find_if(lines.begin(), lines.end(), [](const std::u32string& line) {
    return line.find(U'└') != std::u32string::npos;
  });
  ASSERT_NE(axis, lines.end());
  const std::u32string& title = *(axis + 2);
  const std::size_t begin = title.find(U't');
  const double middle = (static_cast<double>(begin) + static_cast<double>(title.size() - 1)) / 2;
  const double of_axis =
      (static_cast<double>(axis->find(U'└') + 1) + static_cast<double>(axis->size() - 1)) / 2;
  EXPECT_NEAR(middle, of_axis, 1);  // of whole letters
}

TEST(Braille, KeepsToTheWidth) {
  Chart chart = ramp();
  chart.title = std::string(200, 'x');
  chart.panels[0].curves[0].name = std::string(100, 'n');
  for (const std::size_t columns : {40U, 61U, 80U, 133U}) {
    for (const auto& line : lines_of(to_braille(chart, columns, false))) EXPECT_LE(line.size(), columns);
  }
}

// Without names the plot ends at the right edge: the last number, of four letters, stands before its tick.
TEST(Braille, KeepsTheLastNumberWithinTheWidth) {
  const Chart chart{"", {{{"t", "s"}, {"", "m"}, {{"", {{0, 0}, {1000, 1}}}}}}};
  for (const std::size_t columns : {40U, 61U, 80U}) {
    const auto lines = lines_of(to_braille(chart, columns, false));
    const auto numbers = std::find_if(lines.begin(), lines.end(), [](const std::u32string& line) {
      return line.find(U"1000") != std::u32string::npos;
    });
    ASSERT_NE(numbers, lines.end());
    EXPECT_EQ(numbers->size(), columns);
    for (const auto& line : lines) EXPECT_LE(line.size(), columns);
  }
}

TEST(Braille, ColoursCurvesWhereAsked) {
  EXPECT_THAT(to_braille(ramp(), 70, true), HasSubstr("\033[34mup\033[0m"));
}

TEST(Braille, DrawsTheEdgesOfTheWidestBandOnly) {
  Curve wide{"most", {}, 0, Curve::Style::band, {}}, narrow{"half", {}, 1, Curve::Style::band, {}};
  for (double x = 0; x <= 10; ++x) {
    wide.points.emplace_back(x, 10);
    wide.other_edge.emplace_back(x, 0);
    narrow.points.emplace_back(x, 6);
    narrow.other_edge.emplace_back(x, 4);
  }
  const std::string text = to_braille({"", {{{"x"}, {"y"}, {wide, narrow}}}}, 60, false);
  std::istringstream stream(text);
  std::vector<std::string> rows;
  for (std::string line; std::getline(stream, line);) {
    if (line.find("│") != std::string::npos || line.find("┤") != std::string::npos) rows.push_back(line);
  }
  ASSERT_GT(rows.size(), 5U);
  const auto has_dots = [](const std::string& row) {
    return row.find("\xE2\xA0") != std::string::npos || row.find("\xE2\xA1") != std::string::npos ||
           row.find("\xE2\xA2") != std::string::npos;
  };
  for (std::size_t r = 0; r < rows.size(); ++r)
    EXPECT_EQ(has_dots(rows[r]), r == 0 || r + 1 == rows.size()) << rows[r];
  EXPECT_NE(text.find("most"), std::string::npos);
  EXPECT_EQ(text.find("half"), std::string::npos);
}

// A circle in dots of a terminal, of which two stand beside and four above each other in a letter that is
// twice as high as wide: in equal scales it is as wide as it is high, and touches the edges that are nearer.
TEST(Braille, DrawsACircleAsACircle) {
  Curve circle{"", {}};
  for (int degree = 0; degree <= 360; ++degree) {
    const double angle = degree * 3.14159265358979 / 180;
    circle.points.emplace_back(std::cos(angle), std::sin(angle));
  }
  Chart chart{"", {{{"x", "m"}, {"y", "m"}, {circle}}}};
  chart.panels[0].equal = true;
  const auto lines = lines_of(to_braille(chart, 60, false));
  std::size_t left = 1000, right = 0, top = 1000, bottom = 0, rows = 0;
  for (std::size_t r = 0; r < lines.size(); ++r) {
    if (lines[r].find(U'│') != std::u32string::npos || lines[r].find(U'┤') != std::u32string::npos) ++rows;
    for (std::size_t c = 0; c < lines[r].size(); ++c) {
      if (!is_dots(lines[r][c])) continue;
      for (std::size_t bit = 0; bit < 8; ++bit) {
        if ((lines[r][c] >> bit & 1U) == 0) continue;
        // Dots 1 2 3 7 of the left column, 4 5 6 8 of the right one, from above.
        const std::size_t x = 2 * c + (bit == 7 || (bit >= 3 && bit < 6) ? 1 : 0);
        const std::size_t y = 4 * r + (bit >= 6 ? 3 : bit % 3);
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
  }
  ASSERT_GT(right, left);
  const double width = static_cast<double>(right - left), height = static_cast<double>(bottom - top);
  EXPECT_NEAR(width, height, 2);  // a dot is rounded at each end
  EXPECT_NEAR(height, 4 * static_cast<double>(rows), 4);
}

TEST(Braille, DrawsNothingAsEmptyAxes) {
  const std::string text = to_braille({"Nothing", {{{"t", "s"}, {"y"}, {{"y", {}}}}}}, 50, false);
  EXPECT_THAT(text, HasSubstr("└"));
}

}  // namespace
}  // namespace oblique::draw
