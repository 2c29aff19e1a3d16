// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <oblique/draw/picture/raster.h>

namespace oblique::draw {

/// Counts the colours of pictures and chooses the few that stand for all of them.
class ColourCount {
 public:
  void add(const Raster& raster);

  /// All the colours where there are no more than `most`, otherwise `most` of them: the box of all colours is
  /// parted again and again where it errs most (P. Heckbert, "Color image quantization", 1982), and the most
  /// frequent colour of each part stands for it, so that paper, pens and fillings stay what they are.
  std::vector<Rgb> palette(std::size_t most) const;

 private:
  std::unordered_map<std::uint32_t, std::uint64_t> counts_;
};

/// Turns colours into indices of the nearest of a palette, always the same for the same colour: nothing is
/// dithered, so what does not change from picture to picture does not flicker.
class PaletteIndex {
 public:
  explicit PaletteIndex(std::vector<Rgb> palette);
  std::vector<std::uint8_t> indices(const Raster& raster);

 private:
  std::uint8_t nearest(const Rgb& colour) const;

  std::vector<Rgb> palette_;
  std::unordered_map<std::uint32_t, std::uint8_t> known_;
};

}  // namespace oblique::draw
