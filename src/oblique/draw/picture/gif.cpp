// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/gif.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <stdexcept>
#include <vector>

#include <gif_lib.h>

#include <oblique/draw/picture/palette.h>

namespace oblique::draw {
namespace {

constexpr std::size_t kMostColours = 255;  // of 256: one index is the transparent one
constexpr int kMost = 65535;               // what 16 bits hold

using Indices = std::vector<std::uint8_t>;

struct Rectangle {
  int left = 0, top = 0, width = 1, height = 1;
};

/// The least rectangle with all pixels that changed; a single pixel where none did: a frame must have one.
Rectangle changed_rectangle(const Indices& before, const Indices& now, int width) {
  const auto w = static_cast<std::size_t>(width);
  std::size_t left = w, right = 0, top = now.size(), bottom = 0;
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (before[k] == now[k]) continue;
    const std::size_t x = k % w, y = k / w;
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  if (left == w) return {};
  return {static_cast<int>(left), static_cast<int>(top), static_cast<int>(right - left + 1),
          static_cast<int>(bottom - top + 1)};
}

struct CloseGif {
  void operator()(GifFileType* gif) const { EGifCloseFile(gif, nullptr); }
};
struct FreeMap {
  void operator()(ColorMapObject* map) const { GifFreeMapObject(map); }
};

int append(GifFileType* gif, const GifByteType* bytes, int n) {
  static_cast<std::string*>(gif->UserData)->append(bytes, bytes + n);
  return n;
}

/// giflib writes into a string, so nothing can fail but memory.
void must(int result) {
  if (result != GIF_OK) throw std::bad_alloc();
}

class Writer {
 public:
  Writer(const std::vector<Rgb>& palette, int width, int height, int delay)
      : width_(width), height_(height), delay_(delay), transparent_(static_cast<int>(palette.size())) {
    int size = 2;  // of the map, a power of two
    while (size <= transparent_) size *= 2;
    std::vector<GifColorType> colours(static_cast<std::size_t>(size), GifColorType{0, 0, 0});
    std::transform(palette.begin(), palette.end(), colours.begin(), [](const Rgb& colour) {
      return GifColorType{colour.red, colour.green, colour.blue};
    });
    map_.reset(GifMakeMapObject(size, colours.data()));
    gif_.reset(EGifOpen(&bytes_, append, nullptr));
    if (!map_ || !gif_) throw std::bad_alloc();
    EGifSetGifVersion(gif_.get(), true);
    must(EGifPutScreenDesc(gif_.get(), width, height, map_->BitsPerPixel, 0, map_.get()));
    put_endless_loop();
  }

  void add(const Indices& now) {
    const Rectangle r =
        before_.empty() ? Rectangle{0, 0, width_, height_} : changed_rectangle(before_, now, width_);
    put_control(!before_.empty());
    must(EGifPutImageDesc(gif_.get(), r.left, r.top, r.width, r.height, false, nullptr));
    Indices line(static_cast<std::size_t>(r.width));
    for (int y = r.top; y < r.top + r.height; ++y) {
      const auto from =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(r.left);
      for (std::size_t x = 0; x < line.size(); ++x) {
        const bool same = !before_.empty() && before_[from + x] == now[from + x];
        line[x] = same ? static_cast<std::uint8_t>(transparent_) : now[from + x];
      }
      must(EGifPutLine(gif_.get(), line.data(), r.width));
    }
    before_ = now;
  }

  std::string finish() {
    gif_.reset();  // writes the end
    return std::move(bytes_);
  }

 private:
  /// The extension that Netscape 2.0 brought in: repeat, 0 times meaning for ever.
  void put_endless_loop() {
    constexpr std::array<std::uint8_t, 3> kForEver{1, 0, 0};
    must(EGifPutExtensionLeader(gif_.get(), APPLICATION_EXT_FUNC_CODE));
    must(EGifPutExtensionBlock(gif_.get(), 11, "NETSCAPE2.0"));
    must(EGifPutExtensionBlock(gif_.get(), static_cast<int>(kForEver.size()), kForEver.data()));
    must(EGifPutExtensionTrailer(gif_.get()));
  }

  void put_control(bool over_the_last) {
    GraphicsControlBlock control{};
    control.DisposalMode = DISPOSE_DO_NOT;
    control.DelayTime = delay_;
    control.TransparentColor = over_the_last ? transparent_ : NO_TRANSPARENT_COLOR;
    std::array<GifByteType, 4> bytes{};
    const std::size_t n = EGifGCBToExtension(&control, bytes.data());
    must(EGifPutExtension(gif_.get(), GRAPHICS_EXT_FUNC_CODE, static_cast<int>(n), bytes.data()));
  }

  std::string bytes_;
  int width_, height_, delay_, transparent_;
  std::unique_ptr<ColorMapObject, FreeMap> map_;
  std::unique_ptr<GifFileType, CloseGif> gif_;
  Indices before_;
};

}  // namespace

std::string encode_gif(std::size_t frames, const std::function<Raster(std::size_t)>& frame, int delay) {
  if (frames == 0) throw std::invalid_argument("a GIF without frames");
  if (delay < 1 || delay > kMost) throw std::invalid_argument("a delay that a GIF cannot hold");
  ColourCount colours;
  int width = 0, height = 0;
  for (std::size_t k = 0; k < frames; ++k) {
    const Raster raster = frame(k);
    if (k == 0) {
      width = raster.width;
      height = raster.height;
    }
    const bool fits =
        width > 0 && height > 0 && width <= kMost && height <= kMost &&
        raster.pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (!fits || raster.width != width || raster.height != height)
      throw std::invalid_argument("frames that make no GIF");
    colours.add(raster);
  }
  const std::vector<Rgb> palette = colours.palette(kMostColours);
  PaletteIndex index(palette);
  Writer writer(palette, width, height, delay);
  for (std::size_t k = 0; k < frames; ++k) writer.add(index.indices(frame(k)));
  return writer.finish();
}

}  // namespace oblique::draw
