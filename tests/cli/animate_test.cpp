// SPDX-License-Identifier: MIT
// `oblique animate`: the analog mechanism over the exact one, and what is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "animation_files.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

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

// There in four frames and back in four: at the end the arrow of the drive turns round.
TEST_F(Animations, ArrowsOfDrivesTurnRoundOnTheWayBack) {
  std::ofstream(file("lift.toml")) << R"(
format = "oblique-mechanism/1"
[frame]
O = [0, 0]
X = [3, 4]
[bodies]
rod = { points = ["A", "B"], length = 30 }
[slides]
s = { point = "A", along = ["O", "X"], of = "rod", angle = "30 deg" }
[drives]
lift = { slides = "s", speed = -20, start = 50 }
[motion]
until = 1
)";
  const Outcome outcome = run("oblique animate " + file("lift.toml") + " --frames 8 -o " + file("lift.svg"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string svg = bytes_of("lift.svg");
  const std::regex pattern(
      R"rx(type="rotate"[^>]*values="([^"]*)"/>\n<path[^>]*/>\n<path[^>]*/>\n<path id="arrow-s")rx");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(svg, match, pattern));
  std::string values = match[1];
  std::replace(values.begin(), values.end(), ';', ' ');
  std::istringstream numbers(values);
  std::vector<double> turned;
  for (double angle = 0; numbers >> angle;) turned.push_back(angle);
  ASSERT_EQ(turned.size(), 9U);
  const double up = -std::atan2(4, 3) * 180 / M_PI;  // clockwise
  for (std::size_t k = 0; k < 9; ++k)
    EXPECT_NEAR(std::remainder(turned[k] - (k < 5 ? up + 180 : up), 360), 0, 1e-3) << k;
}

struct RefusedAnimation {
  const char* name;
  const char* arguments;
  int status;
  const char* says;
};

void PrintTo(const RefusedAnimation& refused, std::ostream* out) {
  *out << refused.arguments;
}

class RefusedAnimations : public ::testing::TestWithParam<RefusedAnimation> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, RefusedAnimations,
    ::testing::Values(
        RefusedAnimation{
            "UnknownEnding", "four-bar -o x.mp4", 2,
            "x.mp4: cannot write a '.mp4' file; expected a name that ends in .svg, .html or .gif"},
        RefusedAnimation{"NoFolder", "four-bar -o nowhere/x.gif", 2,
                         "nowhere/x.gif: the folder of this file does not exist"},
        RefusedAnimation{"SizeZero", "four-bar --size 0 -o x.svg", 2,
                         "--size: 0; expected a whole number from 100 to 4000"},
        RefusedAnimation{"RateZero", "four-bar --rate 0 -o x.gif", 2,
                         "--rate 0; expected a finite number above 0"},
        RefusedAnimation{"RateNoNumber", "four-bar --rate fast -o x.gif", 2, "--rate fast"},
        RefusedAnimation{"RateTooHigh", "four-bar --rate 60 -o x.gif", 2,
                         "60 frames a second in a GIF; expected at most 50, and at least one in 655 s"},
        RefusedAnimation{"FramesTooFast", "four-bar --frames 300 -o x.gif", 2,
                         "75 frames a second in a GIF; expected at most 50, and at least one in 655 s\n"
                         "  remedy: choose other --frames or another --duration"},
        RefusedAnimation{"RateTooLow", "four-bar --rate 0.001 --frames 10 -o x.gif", 2,
                         "0.001 frames a second in a GIF"},
        RefusedAnimation{"TooFewFrames", "four-bar --duration 0.1 -o x.gif", 2,
                         "0.1 s at 25 frames a second are 3 frames; expected 8 to 3600 frames"},
        RefusedAnimation{
            "Contradiction", "four-bar --frames 90 --duration 4 --rate 10 -o x.gif", 2,
            "--frames 90, --duration 4 s and --rate 10 contradict each other: 4 s at 10 frames a second "
            "are 40 "
            "frames\n  remedy: leave one of the three out"},
        RefusedAnimation{"RateOfSvg", "four-bar --rate 10 -o x.svg", 2,
                         "--rate 10 is for a .gif: others move evenly between their frames\n"
                         "  remedy: leave it out; --frames says how many positions are computed"},
        RefusedAnimation{"RateOfPage", "four-bar --rate 10 -o x.html", 2, "--rate 10 is for a .gif"},
        RefusedAnimation{"MagnifyZero", "four-bar --magnify 0 -o x.svg", 2,
                         "--magnify 0; expected a finite number above 0"},
        RefusedAnimation{"GainAlone", "four-bar --gain 1e3 -o x.svg", 2, "--gain requires --magnify"},
        RefusedAnimation{"UnknownMethod", "four-bar --magnify 10 --method triangle -o x.svg", 2,
                         "--method triangle; expected triangles, gradient or paper"},
        RefusedAnimation{"GainZero", "four-bar --magnify 10 --gain 0 -o x.svg", 2,
                         "--gain 0; expected a finite number above 0"},
        RefusedAnimation{"CannotBePatched", "class-iv --magnify 10 -o x.svg", 1,
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
