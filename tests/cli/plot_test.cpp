// SPDX-License-Identifier: MIT
// What --plot and report draw: read back from the files and held against numbers that come another way.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <oblique/draw/picture.h>

#include <unistd.h>

#include "../support/process.h"

namespace oblique::test {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using testing::HasSubstr;
using testing::Not;

/// A picture as it was written. (std::regex would recurse as deep as a path is long.)
class Svg {
 public:
  explicit Svg(std::string text) : text_(std::move(text)) {}

  AlignedBox2d plot(int panel) const {
    const std::string element = with_id("plot-" + std::to_string(panel));
    const Vector2d corner(number(element, "x"), number(element, "y"));
    return {corner, Vector2d(corner + Vector2d(number(element, "width"), number(element, "height")))};
  }

  std::vector<Vector2d> curve(int panel, int index) const {
    std::string path =
        attribute(with_id("curve-" + std::to_string(panel) + "-" + std::to_string(index)), "d");
    for (char& c : path) {
      if (c == 'M' || c == 'L') c = ' ';
    }
    std::istringstream numbers(path);
    std::vector<Vector2d> points;
    for (double x = 0, y = 0; numbers >> x >> y;) points.emplace_back(x, y);
    return points;
  }

  std::vector<Label> labels() const {
    std::vector<Label> labels;
    for (const std::string& element : elements("<text ")) {
      const std::size_t end = element.find('>');
      Label label{{number(element, "x"), number(element, "y")},
                  element.substr(end + 1, element.find('<', end) - end - 1),
                  Anchor::start,
                  number(element, "font-size")};
      if (element.find("\"middle\"") != std::string::npos) label.anchor = Anchor::middle;
      if (element.find("\"end\"") != std::string::npos) label.anchor = Anchor::end;
      label.bold = element.find("\"bold\"") != std::string::npos;
      labels.push_back(label);
    }
    return labels;
  }

  std::vector<Vector2d> discs() const {
    std::vector<Vector2d> centres;
    for (const std::string& element : elements("<circle "))
      centres.emplace_back(number(element, "cx"), number(element, "cy"));
    return centres;
  }

  Vector2d size() const { return {number(text_, "width"), number(text_, "height")}; }

 private:
  /// The lines that begin so: the writer puts an element on each.
  std::vector<std::string> elements(const std::string& head) const {
    std::vector<std::string> found;
    std::istringstream stream(text_);
    for (std::string line; std::getline(stream, line);) {
      if (line.starts_with(head)) found.push_back(line);
    }
    return found;
  }
  std::string with_id(const std::string& id) const {
    for (const char* head : {"<path ", "<rect "}) {
      for (const std::string& element : elements(head)) {
        if (element.find(" id=\"" + id + "\"") != std::string::npos) return element;
      }
    }
    throw std::runtime_error("there is no " + id);
  }
  static std::string attribute(const std::string& element, const std::string& name) {
    const std::size_t begin = element.find(" " + name + "=\"") + name.size() + 3;
    return element.substr(begin, element.find('"', begin) - begin);
  }
  static double number(const std::string& element, const std::string& name) {
    return std::stod(attribute(element, name));
  }

  std::string text_;
};

class Plot : public testing::Test {
 protected:
  Plot() : folder_(std::filesystem::temp_directory_path() / ("oblique-plot-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Plot() override { std::filesystem::remove_all(folder_); }

  static Outcome oblique(const std::string& arguments) {
    return run_command("oblique " + arguments, OBLIQUE_SOURCE_DIR);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::string bytes_of(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  Svg drawn(const std::string& arguments) const {
    const Outcome outcome = oblique(arguments + " --plot " + file("plot.svg"));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Svg(bytes_of("plot.svg"));
  }

 private:
  std::filesystem::path folder_;
};

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
  for (const Label& label : svg.labels()) {
    std::string text = label.text;
    if (text.starts_with("−")) text = "-" + text.substr(3);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end != '\0') continue;
    // numbers of y stand a little under their lines, so that they are in the middle of them
    if (label.anchor == Anchor::middle) x_numbers[value] = label.at.x();
    if (label.anchor == Anchor::end) y_numbers[value] = label.at.y() - 0.35 * label.size;
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

TEST_F(Plot, CompareDrawsErrorsAndTheirSlope) {
  const Svg svg = drawn("compare diagrams/mechanisms/four-bar.toml -o " + file("errors.json"));
  const auto json = nlohmann::json::parse(bytes_of("errors.json"));
  const AlignedBox2d plot = svg.plot(0);
  const auto measured = svg.curve(0, 0), slope = svg.curve(0, 1);
  ASSERT_EQ(measured.size(), json["runs"].size());
  double least = 1e300, greatest = 0;
  for (const auto& run : json["runs"]) {
    least = std::min(least, run["max_error"].get<double>());
    greatest = std::max(greatest, run["max_error"].get<double>());
  }
  const double low = std::floor(std::log10(least)), high = std::ceil(std::log10(greatest));
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double exponent = std::log10(json["runs"][k]["max_error"].get<double>());
    EXPECT_NEAR(measured[k].y(), plot.max().y() - (exponent - low) / (high - low) * plot.sizes().y(), 0.01);
  }
  // one decade of the gain against one of the error
  const double decade_x = (measured[4].x() - measured[0].x()) / 4;
  const double decade_y = plot.sizes().y() / (high - low);
  const Vector2d fall = slope.back() - slope.front();
  EXPECT_NEAR(-fall.y() / decade_y / (fall.x() / decade_x), json["order"].get<double>(), 1e-3);
  bool named = false;
  for (const Label& label : svg.labels()) named = named || label.text == "slope −1.000";
  EXPECT_TRUE(named);
  // the largest error along the turn is the largest error
  double top = 1e300;
  for (const Vector2d& point : svg.curve(1, 0)) top = std::min(top, point.y());
  const AlignedBox2d along = svg.plot(1);
  EXPECT_NEAR((top - along.min().y()) / along.sizes().y() * (high - low), high - std::log10(greatest), 1e-3);
}

TEST_F(Plot, MonteCarloIsAHistogram) {
  const Svg svg =
      drawn("compare diagrams/mechanisms/four-bar.toml --monte-carlo 30 --tolerance 0.1% --threads 2 -o " +
            file("runs.json"));
  const auto errors = nlohmann::json::parse(bytes_of("runs.json"))["monte_carlo"]["errors"];
  const auto steps = svg.curve(1, 0);
  // the area under the steps, in runs: each of the 7 classes has as many as fall into it
  const AlignedBox2d plot = svg.plot(1);
  const double width = plot.sizes().x() / 7;
  double area = 0;
  for (std::size_t k = 1; k < steps.size(); ++k)
    area += (steps[k].x() - steps[k - 1].x()) / width * (plot.max().y() - steps[k].y());
  std::vector<double> counts(7, 0);
  double least = 1e300, greatest = 0;
  for (const double error : errors) least = std::min(least, error), greatest = std::max(greatest, error);
  for (const double error : errors)
    counts[std::min<std::size_t>(6, static_cast<std::size_t>((error - least) / (greatest - least) * 7))] += 1;
  const double most = *std::max_element(counts.begin(), counts.end());
  double highest = 1e300;
  for (const Vector2d& point : steps) highest = std::min(highest, point.y());
  EXPECT_NEAR(area / ((plot.max().y() - highest) / most), 30, 0.1);
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

TEST_F(Plot, TextsOfShippedExamplesCoverNothing) {
  for (const char* arguments :
       {"run diagrams/historical/lotka-volterra.toml", "run diagrams/lessons/double-pendulum.toml",
        "compare diagrams/mechanisms/four-bar.toml --method triangles,gradient",
        "compare diagrams/mechanisms/slider-crank.toml --monte-carlo 20 --tolerance 1%",
        "check diagrams/lessons/damped-oscillator.toml"}) {
    SCOPED_TRACE(arguments);
    const Svg svg = drawn(arguments);
    const auto labels = svg.labels();
    const AlignedBox2d paper(Vector2d(0, 0), svg.size());
    EXPECT_GT(labels.size(), 5U);
    for (std::size_t a = 0; a < labels.size(); ++a) {
      const AlignedBox2d extent = extent_of(Mark{labels[a]});
      EXPECT_TRUE(paper.contains(extent)) << labels[a].text;
      EXPECT_FALSE(svg.plot(0).intersects(extent)) << labels[a].text;
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_FALSE(extent.intersects(extent_of(Mark{labels[b]})))
            << labels[a].text << " and " << labels[b].text;
    }
  }
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
       {Bad{"run " + side + " --against side", "--against is about a drawing; expected --plot beside it"},
        Bad{"run " + side + " --plot - --against sid", "--against: there is no column 'sid'"},
        Bad{"run " + side + " --plot - --columns t", "nothing is left to draw against 't'"},
        Bad{"run " + side + " --plot x.gif", "cannot write a '.gif' file"},
        Bad{"run " + side + " --plot nowhere/x.svg", "the folder of this file does not exist"},
        Bad{"run " + side + " --plot - --static-test", "--static-test runs nothing, so --plot has nothing"},
        Bad{"compare " + four_bar + " --json --plot -", "--json and --plot - would both print"},
        Bad{"check " + side + " --json --plot -", "--json and --plot - would both print"},
        Bad{"check " + four_bar + " --plot -", "a mechanism has no eigenvalues to plot"},
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
  EXPECT_THAT(outcome.err, HasSubstr("drawn are the first 18 columns; --columns names others of the 2 more"));
  std::string all = "c0";
  for (int k = 1; k < 20; ++k) all += ",c" + std::to_string(k);
  const Outcome refused = oblique("run " + file("many.toml") + " --plot - --columns " + all);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("20 curves cannot be told apart; expected at most 18 in --columns"));
}

TEST_F(Plot, TheReportIsOnePageWithAllOfIt) {
  const std::string four_bar = "diagrams/mechanisms/four-bar.toml";
  const Outcome outcome = oblique("report " + four_bar + " --machine tr-10 -o " + file("page.html"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string page = bytes_of("page.html");
  for (const char* part :
       {"<!DOCTYPE html>", "<h2>Structure</h2>", "C lies left of B → D", "<h2>Patch</h2>",
        "its servo loops come to rest everywhere", "<h2>Convergence</h2>", "falls with the gain to the power",
        "<h2>Stability</h2>", "least damped mode", "@media print", "prefers-color-scheme: dark", "</html>"})
    EXPECT_THAT(page, HasSubstr(part));
  for (const char* outside : {"<script", "src=", "href=", "url(", "id=\"curve"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  // the errors are those of `compare`
  const auto json = nlohmann::json::parse(oblique("compare " + four_bar + " --json").out);
  std::ostringstream error;
  error << std::scientific;
  error.precision(3);
  error << json["runs"][2]["max_error"].get<double>();
  EXPECT_THAT(page, HasSubstr(error.str()));
}

}  // namespace
}  // namespace oblique::test
