// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace oblique::draw {

struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Rgb&) const = default;
};

/// A picture in dots, row by row from the upper left.
struct Raster {
  int width = 0, height = 0;  ///< [px]
  std::vector<Rgb> pixels;    ///< width · height of them
};

}  // namespace oblique::draw
