// SPDX-License-Identifier: MIT
// GIFs, read back by giflib's decoder and put together as browsers do.
#include <oblique/draw/picture/gif.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/draw/picture/palette.h>

#include "../support/gif_reading.h"

namespace oblique::test {
namespace {

using ::testing::Each;
using ::testing::Eq;

constexpr draw::Rgb kPaper{255, 255, 255}, kInk{26, 26, 26}, kBlue{0, 114, 178};

/// Paper with a dot of 2 × 2 px that goes to the right.
draw::Raster dot_at(std::size_t x) {
  draw::Raster raster{20, 10, std::vector<draw::Rgb>(200, kPaper)};
  for (const std::size_t y : {4U, 5U}) {
    for (const std::size_t dx : {0U, 1U}) raster.pixels[20 * y + x + dx] = x < 8 ? kInk : kBlue;
  }
  return raster;
}

/// Paper in the upper half; below it one of 4096 colours a pixel, `shift` of them farther on.
draw::Raster many_colours(std::size_t shift) {
  draw::Raster raster{64, 128, std::vector<draw::Rgb>(std::size_t{64} * 128, kPaper)};
  for (std::size_t k = 0; k < 4096; ++k) {
    const std::size_t colour = (k + shift) % 4096;
    raster.pixels[4096 + k] = {static_cast<std::uint8_t>(4 * (colour % 64)),
                               static_cast<std::uint8_t>(4 * (colour / 64)), 90};
  }
  return raster;
}

TEST(Gif, ShowsEveryFrameAsItWasGiven) {
  const ShownGif gif = read_gif(draw::encode_gif(
      9, [](std::size_t k) { return dot_at(2 * k); }, 7));
  EXPECT_EQ(gif.width, 20);
  EXPECT_EQ(gif.height, 10);
  EXPECT_EQ(gif.repeats, 0);
  EXPECT_TRUE(gif.one_palette);
  EXPECT_EQ(gif.colours, 4U);  // three and the transparent one
  EXPECT_THAT(gif.delays, Each(Eq(7)));
  ASSERT_EQ(gif.frames.size(), 9U);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_EQ(gif.frames[k].pixels, dot_at(2 * k).pixels) << k;
}

// The dot goes by its own width: what it leaves and where it comes to are 4 × 2 px.
TEST(Gif, HoldsOnlyWhatChanged) {
  const ShownGif gif = read_gif(draw::encode_gif(
      5, [](std::size_t k) { return dot_at(2 * std::min(k, std::size_t{3})); }, 4));
  ASSERT_EQ(gif.patches.size(), 5U);
  EXPECT_EQ(gif.patches[0].pixels.size(), 200U);
  for (const std::size_t k : {1U, 2U, 3U}) {
    EXPECT_EQ(gif.patches[k].width, 4) << k;
    EXPECT_EQ(gif.patches[k].height, 2) << k;
  }
  EXPECT_EQ(gif.patches[4].pixels.size(), 1U);  // nothing did
}

TEST(Gif, HoldsOneFrame) {
  const ShownGif gif = read_gif(draw::encode_gif(
      1, [](std::size_t) { return dot_at(3); }, 100));
  ASSERT_EQ(gif.frames.size(), 1U);
  EXPECT_EQ(gif.frames[0].pixels, dot_at(3).pixels);
}

// 4096 colours, evenly over a square of 256 × 256, in 254 parts: about 16 each, 4 × 4 of them 4 apart, so
// that the farthest in a part lie 17 apart; parts that are twice as long as wide, 31.
TEST(Gif, KeepsNearToMoreColoursThanItHas) {
  const ShownGif gif = read_gif(draw::encode_gif(
      2, [](std::size_t k) { return many_colours(64 * k); }, 4));
  EXPECT_EQ(gif.colours, 256U);
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const draw::Raster given = many_colours(64 * frame);
    for (std::size_t k = 0; k < given.pixels.size(); ++k) {
      const draw::Rgb &is = gif.frames[frame].pixels[k], &was = given.pixels[k];
      if (was == kPaper) {
        ASSERT_EQ(is, kPaper);
      }
      ASSERT_LE(std::hypot(is.red - was.red, is.green - was.green, is.blue - was.blue), 31);
    }
  }
}

// Three dark pixels, then two white ones: the last run of a picture counts as every other.
TEST(Gif, KeepsTheMostFrequentOfItsColours) {
  draw::ColourCount count;
  count.add({5, 1, {kInk, kInk, kInk, kPaper, kPaper}});
  EXPECT_EQ(count.palette(1), std::vector<draw::Rgb>{kInk});
  count.add({3, 1, {kInk, kPaper, kPaper}});
  count.add({1, 1, {kPaper}});
  EXPECT_EQ(count.palette(1), std::vector<draw::Rgb>{kPaper});
}

// Without dithering a colour is always shown as the same one, wherever and whenever it stands.
TEST(Gif, ShowsAColourAlwaysTheSame) {
  const ShownGif gif = read_gif(draw::encode_gif(
      3, [](std::size_t k) { return many_colours(100 * k); }, 4));
  std::map<int, draw::Rgb> shown;
  for (std::size_t frame = 0; frame < 3; ++frame) {
    const draw::Raster given = many_colours(100 * frame);
    for (std::size_t k = 0; k < given.pixels.size(); ++k) {
      const draw::Rgb& was = given.pixels[k];
      const auto known =
          shown.try_emplace(was.red << 16 | was.green << 8 | was.blue, gif.frames[frame].pixels[k]);
      ASSERT_EQ(known.first->second, gif.frames[frame].pixels[k]);
    }
  }
}

TEST(Gif, HasTheSameBytesForTheSameFrames) {
  const auto bytes = [] {
    return draw::encode_gif(
        3, [](std::size_t k) { return many_colours(k); }, 4);
  };
  EXPECT_EQ(bytes(), bytes());
}

TEST(Gif, IsRefusedWhereItCannotBe) {
  const auto dot = [](std::size_t) { return dot_at(0); };
  EXPECT_THROW(draw::encode_gif(0, dot, 4), std::invalid_argument);
  EXPECT_THROW(draw::encode_gif(1, dot, 0), std::invalid_argument);
  EXPECT_THROW(draw::encode_gif(1, dot, 65536), std::invalid_argument);
  EXPECT_THROW(draw::encode_gif(
                   1, [](std::size_t) { return draw::Raster{}; }, 4),
               std::invalid_argument);
  EXPECT_THROW(draw::encode_gif(
                   2, [](std::size_t k) { return k == 0 ? dot_at(0) : many_colours(0); }, 4),
               std::invalid_argument);
  EXPECT_THROW(draw::encode_gif(
                   1,
                   [](std::size_t) {
                     return draw::Raster{4, 4, std::vector<draw::Rgb>(15)};
                   },
                   4),
               std::invalid_argument);
  EXPECT_THROW(read_gif("GIF89a"), std::runtime_error);
}

TEST(Gif, HoldsASinglePoint) {
  draw::Raster point;
  point.width = point.height = 1;
  point.pixels = {{10, 20, 30}};
  const ShownGif gif = read_gif(draw::encode_gif(
      2, [&](std::size_t) { return point; }, 4));
  EXPECT_EQ(gif.width, 1);
  ASSERT_EQ(gif.frames.size(), 2U);
  for (const auto& frame : gif.frames) EXPECT_EQ(frame.pixels, point.pixels);
}

}  // namespace
}  // namespace oblique::test
