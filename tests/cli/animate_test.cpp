// SPDX-License-Identifier: MIT
// `oblique animate`: what its files show at which moment, held against other verbs' numbers.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>

#include <Eigen/Core>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include "../support/gif_reading.h"
#include "../support/process.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using testing::Each;
using testing::Eq;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kFourBar = "diagrams/mechanisms/four-bar.toml";
constexpr double kWidth = 760;  // of a picture at 100 % [px]

/// Columns of a CSV file by their names.
using Table = std::map<std::string, std::vector<double>>;

/// Where points of the four-bar linkage stand in a picture, told by its fixed pins A (0, 0) and D (4, 0).
struct Scale {
  Vector2d a = Vector2d::Zero();
  double unit = 0;  ///< [px]

  explicit Scale(const std::string& svg) {
    const auto pin = [&](const std::string& point) {
      // Of a drawing the place itself, of an animation the shift around it.
      std::smatch match;
      const std::regex drawn("id=\"pin-" + point + R"rx("[^>]*cx="([^"]*)" cy="([^"]*)")rx");
      if (!std::regex_search(svg, match, drawn)) throw std::runtime_error("no pin " + point);
      const Vector2d own(std::stod(match[1]), std::stod(match[2]));
      const std::string before = svg.substr(0, static_cast<std::size_t>(match.position()));
      const std::size_t shift = before.rfind("translate(");
      if (shift == std::string::npos) return own;
      std::istringstream numbers(before.substr(shift + 10));
      Vector2d at;
      numbers >> at.x() >> at.y();
      return Vector2d(at + own);
    };
    a = pin("A");
    unit = (pin("D") - a).norm() / 4;
  }
  Vector2d pixel(const Vector2d& place) const { return a + unit * Vector2d(place.x(), -place.y()); }
};

class Animations : public testing::Test {
 protected:
  Animations()
      : folder_(std::filesystem::temp_directory_path() / ("oblique-animations-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Animations() override { std::filesystem::remove_all(folder_); }

  static Outcome run(const std::string& command) { return run_command(command, OBLIQUE_SOURCE_DIR); }
  static bool can_draw() { return run("command -v rsvg-convert").status == 0; }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string bytes_of(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  bool is_empty() const { return std::filesystem::is_empty(folder_); }

  /// What a command writes to -o as CSV.
  Table table_of(const std::string& command) const {
    const Outcome outcome = run(command + " -o " + file("table.csv"));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::istringstream lines(bytes_of("table.csv"));
    std::string line;
    std::getline(lines, line);
    std::vector<std::string> names;
    std::istringstream header(line);
    for (std::string name; std::getline(header, name, ',');) names.push_back(name.substr(0, name.find(' ')));
    Table table;
    while (std::getline(lines, line)) {
      std::istringstream fields(line);
      for (const std::string& name : names) {
        std::string field;
        std::getline(fields, field, ',');
        table[name].push_back(std::strtod(field.c_str(), nullptr));
      }
    }
    return table;
  }

 private:
  std::filesystem::path folder_;
};

int brightness(const ShownGif& gif, std::size_t frame, const Vector2d& at) {
  const auto x = static_cast<std::size_t>(at.x()), y = static_cast<std::size_t>(at.y());
  const Rgb& p = gif.frames[frame].pixels[y * static_cast<std::size_t>(gif.width) + x];
  return (p.red + p.green + p.blue) / 3;
}

/// Whether a pin is drawn there: paper in the middle, and its ring of 4.5 px around it in all directions.
bool shows_pin(const ShownGif& gif, std::size_t frame, const Vector2d& at, double zoom) {
  constexpr int kPaper = 225, kInk = 110, kDirections = 8;  // a ring 1.8 px wide fills most of a pixel on it
  if (brightness(gif, frame, at) < kPaper) return false;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2 * M_PI * k / kDirections;
    if (brightness(gif, frame, at + 4.5 * zoom * Vector2d(std::cos(angle), std::sin(angle))) > kInk)
      return false;
  }
  return true;
}

TEST_F(Animations, GifShowsPinsWhereTheMotionSays) {
  if (!can_draw()) GTEST_SKIP() << "rsvg-convert is not installed";
  const Outcome outcome =
      run("oblique animate " + kFourBar + " --frames 20 --rate 10 --size 600 -o " + file("x.gif"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("note")));
  const ShownGif gif = read_gif(bytes_of("x.gif"));
  ASSERT_EQ(gif.frames.size(), 20U);
  EXPECT_THAT(gif.delays, Each(Eq(10)));
  EXPECT_EQ(gif.repeats, 0);
  EXPECT_TRUE(gif.one_palette);
  EXPECT_EQ(gif.width, 600);
  run("oblique draw " + kFourBar + " -o " + file("x.svg"));
  const Scale scale(bytes_of("x.svg"));
  const Table exact = table_of("oblique solve " + kFourBar + " --positions 21");
  constexpr double kZoom = 600 / kWidth;
  for (std::size_t k = 0; k < 20; ++k) {
    const Vector2d b(exact.at("B.x")[k], exact.at("B.y")[k]), c(exact.at("C.x")[k], exact.at("C.y")[k]);
    EXPECT_TRUE(shows_pin(gif, k, kZoom * scale.pixel(b), kZoom)) << "B in frame " << k;
    EXPECT_TRUE(shows_pin(gif, k, kZoom * scale.pixel(c), kZoom)) << "C in frame " << k;
    EXPECT_FALSE(shows_pin(gif, (k + 1) % 20, kZoom * scale.pixel(b), kZoom)) << "B in frame " << k + 1;
    // The driven link is orange: more red than blue in its middle, even under the plate of the coupler.
    const Vector2d middle = kZoom * scale.pixel(b / 2);
    const Rgb& orange =
        gif.frames[k]
            .pixels[static_cast<std::size_t>(middle.y()) * 600 + static_cast<std::size_t>(middle.x())];
    EXPECT_GT(orange.red, orange.blue + 40) << "crank in frame " << k;
  }
}

// The scale, the title and all of the grid that the mechanism never comes near stay as they are, bit by bit.
TEST_F(Animations, GifDoesNotFlicker) {
  if (!can_draw()) GTEST_SKIP() << "rsvg-convert is not installed";
  run("oblique animate " + kFourBar + " --frames 16 -o " + file("x.gif"));
  const ShownGif gif = read_gif(bytes_of("x.gif"));
  run("oblique draw " + kFourBar + " -o " + file("x.svg"));
  const Scale scale(bytes_of("x.svg"));
  // Where its points go: x from −1 to 4, y from −1 to 3; 60 px around for links, pins and names.
  const Vector2d upper_left = scale.pixel({-1, 3}) - Vector2d(60, 60),
                 lower_right = scale.pixel({4, -1}) + Vector2d(60, 60);
  constexpr int kCaptionFrom = 36, kCaptionTo = 60, kCaptionWidth = 150;
  std::size_t still = 0;
  for (int y = 0; y < gif.height; ++y) {
    for (int x = 0; x < gif.width; ++x) {
      const bool swept =
          x > upper_left.x() && x < lower_right.x() && y > upper_left.y() && y < lower_right.y();
      const bool caption = y >= kCaptionFrom && y < kCaptionTo && x < kCaptionWidth;
      if (swept || caption) continue;
      ++still;
      const auto at = static_cast<std::size_t>(y * gif.width + x);
      for (const Raster& frame : gif.frames)
        ASSERT_EQ(frame.pixels[at], gif.frames[0].pixels[at]) << x << " " << y;
    }
  }
  EXPECT_GT(still, 50'000U);
  EXPECT_NE(gif.frames[0].pixels, gif.frames[1].pixels);
}

TEST_F(Animations, GifIsTheSameForTheSameRequest) {
  if (!can_draw()) GTEST_SKIP() << "rsvg-convert is not installed";
  for (const char* name : {"one.gif", "two.gif"})
    EXPECT_EQ(run("oblique animate " + kFourBar + " --frames 8 --size 300 -o " + file(name)).status, 0);
  EXPECT_EQ(bytes_of("one.gif"), bytes_of("two.gif"));
}

struct Pace {
  const char* asked;
  std::size_t frames;
  int delay;
  const char* note;  ///< empty: it is as asked for
};

// Two of --frames, --duration and --rate make the third; delays are whole hundredths of a second.
TEST_F(Animations, GifGoesAsFastAsItCan) {
  if (!can_draw()) GTEST_SKIP() << "rsvg-convert is not installed";
  for (const Pace& pace : std::vector<Pace>{
           {"--duration 1", 25, 4, ""},
           {"--frames 10 --duration 1", 10, 10, ""},
           {"--frames 10 --rate 20", 10, 5, ""},
           {"--duration '1.5 s' --rate 10", 15, 10, ""},
           {"--frames 15 --duration 1.5 --rate 10", 15, 10, ""},
           {"--frames 12 --rate 30", 12, 3, "12 frames, 33.33 frames a second, 0.36 s a round"},
           {"--frames 30 --duration 1", 30, 3, "30 frames, 33.33 frames a second, 0.9 s a round"}}) {
    SCOPED_TRACE(pace.asked);
    const Outcome outcome =
        run("oblique animate " + kFourBar + " --size 120 " + pace.asked + " -o " + file("x.gif"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const ShownGif gif = read_gif(bytes_of("x.gif"));
    EXPECT_EQ(gif.frames.size(), pace.frames);
    EXPECT_THAT(gif.delays, Each(Eq(pace.delay)));
    const std::string note = "note: a GIF shows a frame for whole hundredths of a second: ";
    if (*pace.note == '\0')
      EXPECT_THAT(outcome.err, Not(HasSubstr(note)));
    else
      EXPECT_THAT(outcome.err, HasSubstr(note + pace.note));
  }
}

TEST_F(Animations, GifNeedsTheConverter) {
  const Outcome without =
      run("PATH=$(dirname $(command -v oblique)); oblique animate " + kFourBar + " -o " + file("x.gif"));
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, HasSubstr("x.gif: a GIF is made by rsvg-convert, which is not installed\n"
                                     "  remedy: install the Debian package librsvg2-bin, or write an .svg"));
  EXPECT_TRUE(is_empty());
}

TEST_F(Animations, GifIsNotBegunWhereTheConverterFails) {
  run("mkdir -p " + file("bin") + " && printf '#!/bin/sh\\nexit 1\\n' > " + file("bin/rsvg-convert") +
      " && chmod +x " + file("bin/rsvg-convert"));
  const Outcome failed =
      run("PATH=" + file("bin") + ":$PATH; oblique animate " + kFourBar + " -o " + file("x.gif"));
  EXPECT_EQ(failed.status, 2);
  EXPECT_THAT(failed.err, HasSubstr("x.gif: rsvg-convert could not draw this"));
  EXPECT_FALSE(std::filesystem::exists(file("x.gif")));
}

// The analog mechanism by `patch` and `run`, the exact one by `solve`: what is drawn is exact + 500 · (analog
// − exact). The runs are sampled in other ways, which with the tolerance of 1e-10 is worth less than 1e-4 px;
// the rest is the rounding of the pins and of the scale to a hundredth of a pixel.
TEST_F(Animations, DrawTheAnalogMechanismWithItsErrorsMagnified) {
  ASSERT_EQ(run("oblique patch " + kFourBar + " --gain 1e3 -o " + file("patch.toml")).status, 0);
  const Table analog = table_of("oblique run " + file("patch.toml"));
  const Table exact = table_of("oblique solve " + kFourBar + " --positions 361");
  const Outcome outcome =
      run("oblique animate " + kFourBar + " --magnify 500 --gain 1e3 --frames 12 -o " + file("x.svg"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string svg = bytes_of("x.svg");
  EXPECT_THAT(svg, HasSubstr("analog, error ×500"));
  const Scale scale(svg);
  double largest = 0;
  for (const std::string point : {"B", "C", "M"}) {
    std::smatch match;
    const std::regex pattern(R"rx(type="translate"[^>]*values="([^"]*)"/>\n<circle id="analog-pin-)rx" +
                             point);
    ASSERT_TRUE(std::regex_search(svg, match, pattern)) << point;
    std::string values = match[1];
    std::replace(values.begin(), values.end(), ';', ' ');
    std::istringstream numbers(values);
    for (std::size_t k = 0; k <= 12; ++k) {
      const auto place = [&](const Table& table) {
        return Vector2d(table.at(point + ".x").at(30 * k), table.at(point + ".y").at(30 * k));
      };
      const Vector2d error = place(analog) - place(exact);
      largest = std::max(largest, scale.unit * 500 * error.norm());
      Vector2d drawn;
      ASSERT_TRUE(numbers >> drawn.x() >> drawn.y());
      EXPECT_LT((drawn - scale.pixel(place(exact) + 500 * error)).norm(), 0.03) << point << " in frame " << k;
    }
  }
  EXPECT_GT(largest, 20);  // [px]: it is the errors that are seen
}

TEST_F(Animations, MagnifiedStillPicturesSayHowLargeTheErrorIs) {
  const Outcome outcome =
      run("oblique draw " + kFourBar + " --magnify 1000 --gain 1e3 --at '80 deg' -o " + file("x.svg"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("note")));
  // 6.02e-4 m at C is what `compare --gain 1e3` finds
  EXPECT_THAT(bytes_of("x.svg"), HasSubstr("largest error 0.000601 m at C, crank = "));
  EXPECT_THAT(bytes_of("x.svg"), HasSubstr("id=\"analog-path-M\""));
}

TEST_F(Animations, ErrorsThatNobodySeesAreRemarkedUpon) {
  const Outcome outcome = run("oblique animate " + kFourBar + " --magnify 10 -o " + file("x.html"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("is still too small to be seen at 10 times its size; --magnify 2e5 shows it well"));
  EXPECT_THAT(run("oblique animate " + kFourBar + " --magnify 1e9 -o " + file("x.html")).err,
              HasSubstr("is larger than the mechanism at 1e+09 times its size; --magnify 2e5"));
}

struct Refused {
  const char* name;
  const char* arguments;
  int status;
  const char* says;
};

void PrintTo(const Refused& refused, std::ostream* out) {
  *out << refused.arguments;
}

class RefusedAnimations : public testing::TestWithParam<Refused> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, RefusedAnimations,
    testing::Values(
        Refused{"UnknownEnding", "four-bar -o x.mp4", 2,
                "x.mp4: cannot write a '.mp4' file; expected a name that ends in .svg, .html or .gif"},
        Refused{"NoFolder", "four-bar -o nowhere/x.gif", 2,
                "nowhere/x.gif: the folder of this file does not exist"},
        Refused{"SizeZero", "four-bar --size 0 -o x.svg", 2, "--size: Value 0 not in range 100 to 4000"},
        Refused{"RateZero", "four-bar --rate 0 -o x.gif", 2, "--rate 0; expected a finite number above 0"},
        Refused{"RateNoNumber", "four-bar --rate fast -o x.gif", 2, "--rate fast"},
        Refused{"RateTooHigh", "four-bar --rate 60 -o x.gif", 2,
                "60 frames a second in a GIF; expected at most 50, and at least one in 655 s"},
        Refused{"FramesTooFast", "four-bar --frames 300 -o x.gif", 2,
                "75 frames a second in a GIF; expected at most 50, and at least one in 655 s\n"
                "  remedy: choose other --frames or another --duration"},
        Refused{"RateTooLow", "four-bar --rate 0.001 --frames 10 -o x.gif", 2,
                "0.001 frames a second in a GIF"},
        Refused{"TooFewFrames", "four-bar --duration 0.1 -o x.gif", 2,
                "0.1 s at 25 frames a second are 3 frames; expected 8 to 3600 frames"},
        Refused{"Contradiction", "four-bar --frames 90 --duration 4 --rate 10 -o x.gif", 2,
                "--frames 90, --duration 4 s and --rate 10 contradict each other: 4 s at 10 frames a second "
                "are 40 "
                "frames\n  remedy: leave one of the three out"},
        Refused{"RateOfSvg", "four-bar --rate 10 -o x.svg", 2,
                "--rate 10 is for a .gif: others move evenly between their frames\n"
                "  remedy: leave it out; --frames says how many positions are computed"},
        Refused{"RateOfPage", "four-bar --rate 10 -o x.html", 2, "--rate 10 is for a .gif"},
        Refused{"MagnifyZero", "four-bar --magnify 0 -o x.svg", 2,
                "--magnify 0; expected a finite number above 0"},
        Refused{"GainAlone", "four-bar --gain 1e3 -o x.svg", 2, "--gain requires --magnify"},
        Refused{"UnknownMethod", "four-bar --magnify 10 --method triangle -o x.svg", 2,
                "--method triangle; expected triangles, gradient or paper"},
        Refused{"GainZero", "four-bar --magnify 10 --gain 0 -o x.svg", 2,
                "--gain 0; expected a finite number above 0"},
        Refused{"CannotBePatched", "class-iv --magnify 10 -o x.svg", 1,
                "cannot be taken apart into triangles; expected drives"}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(RefusedAnimations, EndWithAMessageAndNoFile) {
  const std::filesystem::path source(OBLIQUE_SOURCE_DIR);
  const Outcome outcome =
      run_command(std::string("oblique animate diagrams/mechanisms/") +
                      std::regex_replace(GetParam().arguments, std::regex("^[^ ]*"), "$&.toml"),
                  source.string());
  EXPECT_EQ(outcome.status, GetParam().status);
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().says));
  EXPECT_THAT(outcome.out, IsEmpty());
  for (const char* name : {"x.svg", "x.html", "x.gif", "x.mp4"})
    EXPECT_FALSE(std::filesystem::exists(source / name));
}

}  // namespace
}  // namespace oblique::test
