// SPDX-License-Identifier: MIT
// GIFs that `oblique animate` writes, decoded: what they show at which moment, held against other verbs'
// numbers.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/gif_reading.h"
#include "animation_files.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using ::testing::Each;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::Not;

int brightness(const ShownGif& gif, std::size_t frame, const Vector2d& at) {
  const auto x = static_cast<std::size_t>(at.x()), y = static_cast<std::size_t>(at.y());
  const draw::Rgb& p = gif.frames[frame].pixels[y * static_cast<std::size_t>(gif.width) + x];
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
  if (!can_draw()) FAIL() << "rsvg-convert is not installed (librsvg2-bin)";
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
    const draw::Rgb& orange =
        gif.frames[k]
            .pixels[static_cast<std::size_t>(middle.y()) * 600 + static_cast<std::size_t>(middle.x())];
    EXPECT_GT(orange.red, orange.blue + 40) << "crank in frame " << k;
  }
}

// The scale, the title and all of the grid that the mechanism never comes near stay as they are, bit by bit.
TEST_F(Animations, GifDoesNotFlicker) {
  if (!can_draw()) FAIL() << "rsvg-convert is not installed (librsvg2-bin)";
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
      for (const draw::Raster& frame : gif.frames)
        ASSERT_EQ(frame.pixels[at], gif.frames[0].pixels[at]) << x << " " << y;
    }
  }
  EXPECT_GT(still, 50'000U);
  EXPECT_NE(gif.frames[0].pixels, gif.frames[1].pixels);
}

TEST_F(Animations, GifIsTheSameForTheSameRequest) {
  if (!can_draw()) FAIL() << "rsvg-convert is not installed (librsvg2-bin)";
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
  if (!can_draw()) FAIL() << "rsvg-convert is not installed (librsvg2-bin)";
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

}  // namespace
}  // namespace oblique::test
