// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/picture/raster.h>

namespace oblique::test {

/// A GIF as a browser shows it.
struct ShownGif {
  int width = 0, height = 0;
  int repeats = -1;  ///< 0: for ever; −1: it says nothing
  std::size_t colours = 0;
  bool one_palette = true;            ///< no frame has one of its own
  std::vector<int> delays;            ///< [1/100 s]
  std::vector<draw::Raster> frames;   ///< each as it is seen, over those before it
  std::vector<draw::Raster> patches;  ///< what the file has of each: the size tells how much was written
};

/// Reads the bytes of a GIF by giflib and puts its frames over each other. Throws std::runtime_error.
ShownGif read_gif(const std::string& bytes);

}  // namespace oblique::test
