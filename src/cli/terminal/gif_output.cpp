// SPDX-License-Identifier: MIT
#include "terminal/gif_output.h"

#include <algorithm>
#include <future>
#include <thread>
#include <vector>

#include <oblique/draw/picture/gif.h>
#include <oblique/draw/picture/svg.h>

#include "terminal/picture_output.h"
#include "terminal/png_reader.h"
#include "terminal/terminal.h"

namespace oblique::cli {

std::string gif_of(const mechanism::Mechanism& mechanism, const draw::LinkageAnimation& animation,
                   draw::Theme theme, int delay, const std::string& path) {
  const draw::AnimationFrames frames(mechanism, animation);
  const std::size_t n = animation.frames.size() - 1;
  const std::size_t at_a_time = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::string> pngs;  // small beside their dots
  Progress progress("drawing frames");
  while (pngs.size() < n) {
    std::vector<std::future<std::string>> batch;
    for (std::size_t k = pngs.size(); k < std::min(n, pngs.size() + at_a_time); ++k) {
      // Deferred where no thread can be had.
      batch.push_back(std::async(std::launch::async | std::launch::deferred, [&, k] {
        const draw::Picture picture = frames.picture(k);
        const double zoom = animation.width > 0 ? animation.width / picture.width : 1;
        return png_of(draw::to_svg(picture, theme, zoom), path);
      }));
    }
    for (std::future<std::string>& png : batch) pngs.push_back(png.get());
    progress.show(static_cast<double>(pngs.size()) / static_cast<double>(n));
  }
  return draw::encode_gif(
      n, [&](std::size_t k) { return read_png(pngs[k], path); }, delay);
}

}  // namespace oblique::cli
