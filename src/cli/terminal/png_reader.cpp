// SPDX-License-Identifier: MIT
#include "terminal/png_reader.h"

#include <cstring>
#include <new>

#include <png.h>

#include <fmt/format.h>

#include <oblique/text/diagnostic.h>

namespace oblique::cli {

draw::Raster read_png(const std::string& bytes, const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  draw::Raster raster;
  std::vector<png_byte> dots;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) != 0) {
    image.format = PNG_FORMAT_RGBA;
    raster.width = static_cast<int>(image.width);
    raster.height = static_cast<int>(image.height);
    dots.resize(PNG_IMAGE_SIZE(image));
    png_image_finish_read(&image, nullptr, dots.data(), 0, nullptr);
  }
  if (PNG_IMAGE_FAILED(image)) {
    if (std::strstr(static_cast<const char*>(image.message), "memory") != nullptr) throw std::bad_alloc();
    throw text::ReadError(text::Diagnostic{
        {path, {}},
        fmt::format("a frame could not be read back: {}", static_cast<const char*>(image.message)),
        {},
        "write an .svg or .html"});
  }
  constexpr std::size_t kSamples = 4;  // red, green, blue, and how opaque it is
  raster.pixels.reserve(dots.size() / kSamples);
  for (std::size_t k = 0; k < dots.size(); k += kSamples)
    raster.pixels.push_back({dots[k], dots[k + 1], dots[k + 2]});
  return raster;
}

}  // namespace oblique::cli
