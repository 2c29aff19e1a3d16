// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/palette.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace oblique::draw {
namespace {

struct Counted {
  std::array<int, 3> colour;
  std::uint64_t count;
};

std::uint32_t key_of(const Rgb& colour) {
  return static_cast<std::uint32_t>(colour.red << 16 | colour.green << 8 | colour.blue);
}

Rgb colour_of_key(std::uint32_t key) {
  return {static_cast<std::uint8_t>(key >> 16), static_cast<std::uint8_t>(key >> 8),
          static_cast<std::uint8_t>(key)};
}

/// Colours that one of them will stand for.
struct Part {
  std::vector<Counted> colours;
  double error = 0;  ///< squared distances from the mean, all pixels
  int axis = 0;      ///< along which they lie farthest apart
  double middle = 0;
};

Part part_of(std::vector<Counted> colours) {
  Part part{std::move(colours)};
  double pixels = 0, widest = -1;
  for (const Counted& c : part.colours) pixels += static_cast<double>(c.count);
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    double sum = 0, squares = 0;
    for (const Counted& c : part.colours) sum += static_cast<double>(c.count) * c.colour[k];
    const double mean = sum / pixels;
    for (const Counted& c : part.colours)
      squares += static_cast<double>(c.count) * (c.colour[k] - mean) * (c.colour[k] - mean);
    part.error += squares;
    if (squares <= widest) continue;
    widest = squares;
    part.axis = axis;
    part.middle = mean;
  }
  return part;
}

Rgb most_frequent(const Part& part) {
  const auto most = std::max_element(part.colours.begin(), part.colours.end(),
                                     [](const Counted& a, const Counted& b) { return a.count < b.count; });
  return {static_cast<std::uint8_t>(most->colour[0]), static_cast<std::uint8_t>(most->colour[1]),
          static_cast<std::uint8_t>(most->colour[2])};
}

}  // namespace

void ColourCount::add(const Raster& raster) {
  std::optional<std::uint32_t> last;
  std::uint64_t run = 0;
  for (const Rgb& colour : raster.pixels) {
    const std::uint32_t key = key_of(colour);
    if (last != key) {
      if (last) counts_[*last] += run;
      last = key;
      run = 0;
    }
    ++run;
  }
  if (last) counts_[*last] += run;
}

std::vector<Rgb> ColourCount::palette(std::size_t most) const {
  std::vector<Counted> all;
  for (const auto& [key, n] : counts_) {
    const Rgb c = colour_of_key(key);
    all.push_back({{c.red, c.green, c.blue}, n});
  }
  std::sort(all.begin(), all.end(), [](const Counted& a, const Counted& b) { return a.colour < b.colour; });
  std::vector<Part> parts;
  if (!all.empty()) parts.push_back(part_of(std::move(all)));
  while (parts.size() < most) {
    const auto worst = std::max_element(parts.begin(), parts.end(),
                                        [](const Part& a, const Part& b) { return a.error < b.error; });
    if (worst == parts.end() || worst->colours.size() < 2) break;
    const auto axis = static_cast<std::size_t>(worst->axis);
    std::vector<Counted> low, high;
    for (const Counted& c : worst->colours) (c.colour[axis] <= worst->middle ? low : high).push_back(c);
    *worst = part_of(std::move(low));
    parts.push_back(part_of(std::move(high)));
  }
  std::vector<Rgb> palette(parts.size());
  std::transform(parts.begin(), parts.end(), palette.begin(), most_frequent);
  return palette;
}

PaletteIndex::PaletteIndex(std::vector<Rgb> palette) : palette_(std::move(palette)) {}

std::uint8_t PaletteIndex::nearest(const Rgb& colour) const {
  int least = std::numeric_limits<int>::max();
  std::size_t best = 0;
  for (std::size_t k = 0; k < palette_.size(); ++k) {
    const int r = palette_[k].red - colour.red, g = palette_[k].green - colour.green,
              b = palette_[k].blue - colour.blue;
    const int distance = r * r + g * g + b * b;
    if (distance >= least) continue;
    least = distance;
    best = k;
  }
  return static_cast<std::uint8_t>(best);
}

std::vector<std::uint8_t> PaletteIndex::indices(const Raster& raster) {
  std::vector<std::uint8_t> indices;
  indices.reserve(raster.pixels.size());
  for (std::size_t k = 0; k < raster.pixels.size(); ++k) {
    const Rgb& colour = raster.pixels[k];
    if (k > 0 && colour == raster.pixels[k - 1]) {
      indices.push_back(indices.back());
      continue;
    }
    const auto [found, is_new] = known_.try_emplace(key_of(colour), std::uint8_t{0});
    if (is_new) found->second = nearest(colour);
    indices.push_back(found->second);
  }
  return indices;
}

}  // namespace oblique::draw
