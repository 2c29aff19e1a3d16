// SPDX-License-Identifier: MIT
#include "gif_reading.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <gif_lib.h>

namespace oblique::test {
namespace {

struct Source {
  const std::string& bytes;
  std::size_t at = 0;
};

int take(GifFileType* gif, GifByteType* into, int n) {
  auto& source = *static_cast<Source*>(gif->UserData);
  const std::size_t count = std::min(static_cast<std::size_t>(n), source.bytes.size() - source.at);
  std::memcpy(into, source.bytes.data() + source.at, count);
  source.at += count;
  return static_cast<int>(count);
}

struct Close {
  void operator()(GifFileType* gif) const { DGifCloseFile(gif, nullptr); }
};

int repeats_in(const SavedImage& image) {
  for (int k = 0; k + 1 < image.ExtensionBlockCount; ++k) {
    const ExtensionBlock &name = image.ExtensionBlocks[k], &data = image.ExtensionBlocks[k + 1];
    if (name.Function == APPLICATION_EXT_FUNC_CODE && name.ByteCount == 11 && data.ByteCount == 3 &&
        std::memcmp(name.Bytes, "NETSCAPE2.0", 11) == 0 && data.Bytes[0] == 1)
      return data.Bytes[1] + 256 * data.Bytes[2];
  }
  return -1;
}

}  // namespace

ShownGif read_gif(const std::string& bytes) {
  Source source{bytes};
  const std::unique_ptr<GifFileType, Close> gif(DGifOpen(&source, take, nullptr));
  if (!gif || DGifSlurp(gif.get()) != GIF_OK) throw std::runtime_error("this is no GIF");
  ShownGif shown;
  shown.width = gif->SWidth;
  shown.height = gif->SHeight;
  shown.colours = static_cast<std::size_t>(gif->SColorMap->ColorCount);
  draw::Raster canvas{gif->SWidth, gif->SHeight, {}};
  canvas.pixels.resize(static_cast<std::size_t>(gif->SWidth) * static_cast<std::size_t>(gif->SHeight));
  for (int k = 0; k < gif->ImageCount; ++k) {
    const SavedImage& image = gif->SavedImages[k];
    GraphicsControlBlock control{};
    DGifSavedExtensionToGCB(gif.get(), k, &control);
    shown.delays.push_back(control.DelayTime);
    shown.repeats = std::max(shown.repeats, repeats_in(image));
    shown.one_palette = shown.one_palette && image.ImageDesc.ColorMap == nullptr;
    if (control.DisposalMode != DISPOSE_DO_NOT) throw std::runtime_error("a frame that does not stay");
    const GifImageDesc& place = image.ImageDesc;
    draw::Raster patch{place.Width, place.Height, {}};
    for (int y = 0; y < place.Height; ++y) {
      for (int x = 0; x < place.Width; ++x) {
        const int index = image.RasterBits[y * place.Width + x];
        const GifColorType& colour = gif->SColorMap->Colors[index];
        patch.pixels.push_back({colour.Red, colour.Green, colour.Blue});
        if (index == control.TransparentColor) continue;
        const auto at = static_cast<std::size_t>(place.Top + y) * static_cast<std::size_t>(gif->SWidth) +
                        static_cast<std::size_t>(place.Left + x);
        canvas.pixels[at] = patch.pixels.back();
      }
    }
    shown.frames.push_back(canvas);
    shown.patches.push_back(std::move(patch));
  }
  return shown;
}

}  // namespace oblique::test
