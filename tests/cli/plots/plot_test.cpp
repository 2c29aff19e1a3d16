// SPDX-License-Identifier: MIT
// What --plot of run and check draws: read back from the files and held against numbers that come another
// way.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "plot_reading.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Plot : public PlotTest {};

// The side of the triangle by the law of cosines; time runs from 0 to 2π, the axis of the side from 0 to 0.8.
// Coordinates are rounded to 0.005 px in x and y, which the slope of the curve adds up to less than 0.01 px;
// the servo's static error of 5e-6 is 0.001 px.
TEST_F(Plot, RunDrawsTheLawOfCosines) {
  const Svg svg = drawn("run diagrams/lessons/triangle-side.toml");
  const AlignedBox2d plot = svg.plot(0);
  const auto points = svg.curve(0, 0);
  ASSERT_GT(points.size(), 600U);
  for (const Vector2d& point : points) {
    const double t = (point.x() - plot.min().x()) / plot.sizes().x() * 2 * std::numbers::pi;
    const double side = std::sqrt(0.09 + 0.16 - 0.24 * std::cos(t));
    EXPECT_NEAR(point.y(), plot.max().y() - side / 0.8 * plot.sizes().y(), 0.012);
  }
}

/// Distance of a point from a line of points.
double distance_from(const std::vector<Vector2d>& line, const Vector2d& point) {
  double nearest = 1e300;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vector2d along = line[k] - line[k - 1];
    const double length = along.squaredNorm();
    const double part = length > 0 ? std::clamp(along.dot(point - line[k - 1]) / length, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (line[k - 1] + part * along - point).norm());
  }
  return nearest;
}

// The path of the patched coupler point goes through the exact places of `solve`, where the numbers of the
// axes put them.
TEST_F(Plot, ThePlottersPathGoesThroughTheExactPlaces) {
  const std::string four_bar = "diagrams/mechanisms/four-bar.toml";
  ASSERT_EQ(oblique("patch " + four_bar + " -o " + file("patched.toml")).status, 0);
  ASSERT_EQ(oblique("solve " + four_bar + " --columns M.x,M.y -o " + file("exact.csv")).status, 0);
  const Svg svg = drawn("run " + file("patched.toml") + " --against M.x --columns M.y");
  std::map<double, double> x_numbers, y_numbers;
  for (const draw::Label& label : svg.labels()) {
    std::string text = label.text;
    if (text.starts_with("−")) text = "-" + text.substr(3);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end != '\0') continue;
    // numbers of y stand a little under their lines, so that they are in the middle of them
    if (label.anchor == draw::Anchor::middle) x_numbers[value] = label.at.x();
    if (label.anchor == draw::Anchor::end) y_numbers[value] = label.at.y() - 4;
  }
  ASSERT_GE(x_numbers.size(), 2U);
  ASSERT_GE(y_numbers.size(), 2U);
  const auto place = [](const std::map<double, double>& numbers, double value) {
    const auto [v0, p0] = *numbers.begin();
    const auto [v1, p1] = *numbers.rbegin();
    return p0 + (value - v0) / (v1 - v0) * (p1 - p0);
  };
  const auto points = svg.curve(0, 0);
  std::ifstream stream(file("exact.csv"));
  std::string line;
  std::getline(stream, line);
  int rows = 0;
  for (; std::getline(stream, line); ++rows) {
    const double x = std::stod(line), y = std::stod(line.substr(line.find(',') + 1));
    // 0.005 px of the numbers and of the points each
    EXPECT_LT(distance_from(points, {place(x_numbers, x), place(y_numbers, y)}), 0.015);
  }
  EXPECT_EQ(rows, 361);
}

// λ = −0.4/2 ± i √(5² − 0.2²) all the time. The real axis goes from there to 0, with room for dots, the
// imaginary one from −6 to 6.
TEST_F(Plot, CheckDrawsEigenvalues) {
  const Svg svg = drawn("check diagrams/lessons/damped-oscillator.toml");
  const AlignedBox2d plot = svg.plot(0);
  const auto rings = svg.discs();
  ASSERT_EQ(rings.size(), 2 * 61U);
  for (const Vector2d& ring : rings) {
    EXPECT_NEAR(ring.x(), plot.min().x() + 0.03 / 1.06 * plot.sizes().x(), 0.01);
    EXPECT_NEAR(std::abs(ring.y() - plot.center().y()), std::sqrt(25 - 0.04) / 12 * plot.sizes().y(), 0.01);
  }
}

TEST_F(Plot, ThemesChooseTheColours) {
  const std::string side = "run diagrams/lessons/triangle-side.toml --plot " + file("x.svg");
  const auto with = [&](const std::string& theme) {
    EXPECT_EQ(oblique(side + theme).status, 0);
    return bytes_of("x.svg");
  };
  const std::string light = with(" --theme light"), dark = with(" --theme dark");
  EXPECT_THAT(light, HasSubstr(".f-paper { fill: #ffffff }"));
  EXPECT_THAT(light, Not(HasSubstr("#16181c")));
  EXPECT_THAT(dark, HasSubstr(".f-paper { fill: #16181c }"));
  EXPECT_THAT(dark, Not(HasSubstr("#ffffff")));
  EXPECT_THAT(with(""), HasSubstr("prefers-color-scheme: dark"));
  EXPECT_EQ(with(""), with(" --theme auto"));
  for (const char* verb :
       {"check diagrams/lessons/triangle-side.toml", "compare diagrams/mechanisms/four-bar.toml"}) {
    EXPECT_EQ(oblique(std::string(verb) + " --theme dark --plot " + file("x.svg")).status, 0);
    EXPECT_THAT(bytes_of("x.svg"), Not(HasSubstr("#ffffff")));
  }
  // a page is light on paper, whatever it is on the screen
  EXPECT_EQ(oblique("report diagrams/mechanisms/four-bar.toml --theme dark -o " + file("x.html")).status, 0);
  const std::string page = bytes_of("x.html");
  const std::size_t print = page.find("@media print");
  EXPECT_THAT(page.substr(0, print), HasSubstr("body { background: #16181c"));
  EXPECT_THAT(page.substr(0, print), Not(HasSubstr("#ffffff")));
  EXPECT_THAT(page.substr(print), HasSubstr("body { background: #ffffff"));
}

TEST_F(Plot, TheTerminalGetsBrailleInPlaceOfTheTable) {
  const Outcome outcome = oblique("run diagrams/lessons/triangle-side.toml --plot -");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("side [m]\n"));
  EXPECT_THAT(outcome.out, HasSubstr("⣀⣀"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("3.14159")));
  EXPECT_THAT(outcome.out, Not(HasSubstr("\033")));
}

TEST_F(Plot, TheSamePictureHasTheSameBytes) {
  drawn("run diagrams/lessons/double-pendulum.toml");
  const std::string once = bytes_of("plot.svg");
  drawn("run diagrams/lessons/double-pendulum.toml");
  EXPECT_EQ(once, bytes_of("plot.svg"));
}

TEST_F(Plot, BadRequestsAreRefusedBeforeTheWork) {
  struct Bad {
    std::string arguments;
    const char* says;
  };
  const std::string side = "diagrams/lessons/triangle-side.toml",
                    four_bar = "diagrams/mechanisms/four-bar.toml";
  for (const Bad& bad :
       {Bad{"run " + side + " --against side",
            "--against chooses the axis of a drawing, and none is asked for; expected --plot beside it"},
        Bad{"run " + side + " --plot - --against sid", "--against: there is no column 'sid'"},
        Bad{"run " + side + " --plot - --columns t", "nothing is left to draw against 't'"},
        Bad{"run " + side + " --plot x.gif", "cannot write a '.gif' file"},
        Bad{"run " + side + " --plot nowhere/x.svg", "the folder of this file does not exist"},
        Bad{"run " + side + " --plot - --static-test", "--static-test runs nothing, so --plot has nothing"},
        Bad{"compare " + four_bar + " --json --plot -", "--json and --plot - would both print"},
        Bad{"check " + side + " --json --plot -", "--json and --plot - would both print"},
        Bad{"check " + four_bar + " --plot -", "a mechanism has no eigenvalues to plot"},
        Bad{"run " + side + " --theme dark",
            "--theme chooses the colours of a drawing, and none is asked for; expected --plot FILE.svg "
            "beside it"},
        Bad{"run " + side + " --plot - --theme dark",
            "--theme chooses the colours of a picture; the terminal has its own"},
        Bad{"check " + side + " --plot x.svg --theme drak", "--theme drak; expected auto, light or dark"},
        Bad{"compare " + four_bar + " --theme dark",
            "--theme chooses the colours of a drawing, and none is asked for"},
        Bad{"report " + four_bar + " -o " + file("x.html") + " --theme paper", "auto, light or dark"},
        Bad{"report " + four_bar + " -o x.pdf", "cannot write a '.pdf' file"},
        Bad{"report " + four_bar + " -o " + file("x.html") + " --machine nosuch", "nosuch"},
        Bad{"report " + four_bar + " -o " + file("x.html") + " --gain 0", "a finite number above 0"}}) {
    SCOPED_TRACE(bad.arguments);
    const Outcome outcome = oblique(bad.arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr(bad.says));
  }
  EXPECT_FALSE(exists("x.html"));
}

TEST_F(Plot, MoreCurvesThanCanBeToldApartAreRefusedOrLeftOut) {
  std::ofstream(file("many.toml")) << [] {
    std::string text = "format = \"oblique-diagram/1\"\n[run]\nuntil = 1\n[blocks]\n";
    for (int k = 0; k < 20; ++k)
      text += "c" + std::to_string(k) + " = { type = \"constant\", value = 0.1 }\n";
    return text;
  }();
  const Outcome outcome = oblique("run " + file("many.toml") + " --plot -");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("only the first 18 columns are drawn; --columns chooses others of the 2 more"));
  std::string all = "c0";
  for (int k = 1; k < 20; ++k) all += ",c" + std::to_string(k);
  const Outcome refused = oblique("run " + file("many.toml") + " --plot - --columns " + all);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("--columns: 20 curves cannot be told apart; expected at most 18"));
}

}  // namespace
}  // namespace oblique::test
