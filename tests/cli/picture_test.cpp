// SPDX-License-Identifier: MIT
// The verbs that make pictures: the files they write, and what they refuse.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class Pictures : public ::testing::Test {
 protected:
  Pictures() : folder_(make_scratch_folder()) { std::filesystem::create_directories(folder_); }
  ~Pictures() override { std::filesystem::remove_all(folder_); }

  static Outcome run(const std::string& command) { return run_command(command, OBLIQUE_SOURCE_DIR); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string bytes_of(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  bool is_empty() const { return std::filesystem::is_empty(folder_); }

 private:
  std::filesystem::path folder_;
};

TEST_F(Pictures, DrawWritesTheMechanismWhereItIsAsked) {
  const Outcome outcome =
      run("oblique draw diagrams/mechanisms/three-bar.toml --at '79 deg' --trace B,P -o " +
          file("three-bar.svg"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, HasSubstr("wrote "));
  const std::string svg = bytes_of("three-bar.svg");
  for (const char* part :
       {"crank = 79°", "path of B", "path of P", "id=\"pin-A\"", "id=\"slide-b\"", "x [mm]"})
    EXPECT_THAT(svg, HasSubstr(part));
}

TEST_F(Pictures, DrawDrawsNoPathsWhereNoneAreWanted) {
  run("oblique draw diagrams/mechanisms/six-bar.toml --trace none -o " + file("six-bar.svg"));
  EXPECT_THAT(bytes_of("six-bar.svg"), HasSubstr("pin-F"));
  EXPECT_THAT(bytes_of("six-bar.svg"), Not(HasSubstr("path of")));
}

TEST_F(Pictures, DrawPlotsAPoint) {
  EXPECT_EQ(run("oblique draw diagrams/mechanisms/six-bar.toml --plots F -o " + file("plots.svg")).status, 0);
  for (const char* part : {"id=\"curve-0-0\"", "velocity in x", "id=\"curve-5-0\"", "crank [°]"})
    EXPECT_THAT(bytes_of("plots.svg"), HasSubstr(part));
}

TEST_F(Pictures, ThemeChoosesTheColours) {
  run("oblique draw diagrams/mechanisms/four-bar.toml --theme dark -o " + file("dark.svg"));
  run("oblique draw diagrams/mechanisms/four-bar.toml -o " + file("auto.svg"));
  EXPECT_THAT(bytes_of("dark.svg"), Not(HasSubstr("prefers-color-scheme")));
  EXPECT_THAT(bytes_of("auto.svg"), HasSubstr("prefers-color-scheme"));
}

TEST_F(Pictures, AnimateWritesSvgAndAPage) {
  EXPECT_EQ(run("oblique animate diagrams/mechanisms/jansen.toml -o " + file("jansen.svg")).status, 0);
  EXPECT_THAT(bytes_of("jansen.svg"), HasSubstr("dur=\"4s\""));
  const Outcome outcome =
      run("oblique animate diagrams/mechanisms/double-rocker.toml --frames 40 --duration 2 -o " +
          file("rocker.html"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(bytes_of("rocker.html"), StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(bytes_of("rocker.html"), Not(HasSubstr("nan")));
}

// Among them mechanisms with change points, with limits, without a full turn, with driven slides.
TEST_F(Pictures, AllShippedMechanismsAreDrawnAndAnimated) {
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms")) {
    SCOPED_TRACE(entry.path().filename().string());
    const std::string mechanism = "'" + entry.path().string() + "'";
    const Outcome drawn =
        run("timeout 20 oblique draw " + mechanism + " --positions 7 -o " + file("all.svg"));
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_THAT(bytes_of("all.svg"), Not(HasSubstr("nan")));
    const Outcome animated = run("timeout 20 oblique animate " + mechanism + " -o " + file("all.html"));
    EXPECT_EQ(animated.status, 0) << animated.err;
    EXPECT_THAT(bytes_of("all.html"), Not(HasSubstr("nan,")));
  }
}

TEST_F(Pictures, PngNeedsItsConverter) {
  const std::string draw = "oblique draw diagrams/mechanisms/four-bar.toml -o " + file("four-bar.png");
  const Outcome without = run("PATH=$(dirname $(command -v oblique)); " + draw);
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, HasSubstr("four-bar.png: a PNG is made by rsvg-convert, which is not installed\n"
                                     "  remedy: install the Debian package librsvg2-bin, or write an .svg"));
  EXPECT_TRUE(is_empty());
  if (run("command -v rsvg-convert").status != 0) FAIL() << "rsvg-convert is not installed (librsvg2-bin)";
  EXPECT_EQ(run(draw).status, 0);
  EXPECT_THAT(bytes_of("four-bar.png"), StartsWith("\x89PNG"));
}

// The rocker turns from 137.87° to −137.87° and no farther, however few the frames: its angle never jumps.
TEST_F(Pictures, AnimationsStayWithinTheLimits) {
  run("oblique animate diagrams/mechanisms/double-rocker.toml --frames 8 -o " + file("rocker.svg"));
  const std::string svg = bytes_of("rocker.svg");
  std::size_t at = svg.rfind("values=\"", svg.find("id=\"body-AB\""));
  ASSERT_NE(at, std::string::npos);
  std::istringstream values(svg.substr(at + 8, svg.find('"', at + 8) - at - 8));
  int frames = 0;
  for (std::string value; std::getline(values, value, ';'); ++frames)
    EXPECT_LT(std::abs(std::strtod(value.c_str(), nullptr)), 140);
  EXPECT_EQ(frames, 9);
}

struct RefusedPicture {
  const char* name;
  const char* arguments;
  int status;
  const char* says;
};

void PrintTo(const RefusedPicture& refused, std::ostream* out) {
  *out << refused.arguments;
}

class RefusedPictures : public ::testing::TestWithParam<RefusedPicture> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, RefusedPictures,
    ::testing::Values(
        RefusedPicture{"UnknownEnding", "draw diagrams/mechanisms/four-bar.toml -o x.bmp", 2,
                       "x.bmp: cannot write a '.bmp' file; expected a name that ends in .svg or .png"},
        RefusedPicture{
            "NoEnding", "animate diagrams/mechanisms/four-bar.toml -o x", 2,
            "x: the name of this file has no ending; expected a name that ends in .svg, .html or .gif"},
        RefusedPicture{"NoFolder", "draw diagrams/mechanisms/four-bar.toml -o nowhere/x.svg", 2,
                       "nowhere/x.svg: the folder of this file does not exist"},
        RefusedPicture{"NoOutput", "draw diagrams/mechanisms/four-bar.toml", 2, "--output is required"},
        RefusedPicture{"UnknownPoint", "draw diagrams/mechanisms/four-bar.toml --trace ZZ9 -o x.svg", 2,
                       "--trace: there is no point 'ZZ9'\n  remedy: known: "},
        RefusedPicture{"UnknownPlot", "draw diagrams/mechanisms/four-bar.toml --plots ZZ9 -o x.svg", 2,
                       "--plots: there is no point 'ZZ9'"},
        RefusedPicture{"PlotsAndPosition", "draw diagrams/mechanisms/four-bar.toml --plots B --at 1 -o x.svg",
                       2, "excludes"},
        RefusedPicture{"UnknownTheme", "draw diagrams/mechanisms/four-bar.toml --theme drak -o x.svg", 2,
                       "--theme drak; expected auto, light or dark\n  remedy: did you mean 'dark'?"},
        RefusedPicture{
            "CannotBeAssembledThere", "draw diagrams/mechanisms/double-rocker.toml --at '180 deg' -o x.svg",
            1,
            "the mechanism cannot be assembled at rocker = 180°\n"
            "  remedy: `oblique check diagrams/mechanisms/double-rocker.toml` says how far it can go"},
        RefusedPicture{"NoDuration", "animate diagrams/mechanisms/four-bar.toml --duration 0 -o x.svg", 2,
                       "--duration 0; expected a finite time above 0"},
        RefusedPicture{"NotAMechanism", "draw README.md -o x.svg", 2, "README.md:"}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(RefusedPictures, EndWithAMessageAndNoFile) {
  const std::filesystem::path source(OBLIQUE_SOURCE_DIR);
  const Outcome outcome = run_command(std::string("oblique ") + GetParam().arguments, source.string());
  EXPECT_EQ(outcome.status, GetParam().status);
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().says));
  for (const char* name : {"x.svg", "x.bmp", "x"}) EXPECT_FALSE(std::filesystem::exists(source / name));
}

}  // namespace
}  // namespace oblique::test
