// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/sequences.h>

#include <array>
#include <numeric>
#include <utility>

#include <oblique/ensemble/study/philox.h>

namespace oblique::ensemble {
namespace {

// What draws, beside the elements of a diagram: numbers that no scatter's place in its list has.
constexpr std::uint32_t kOrder = 0xFFFFFFF0, kPlace = 0xFFFFFFF1;

/// A primitive polynomial over the field of two, xˢ + a₁xˢ⁻¹ + … + 1, with a₁ … as the bits of `a`, and the
/// first direction numbers.
struct Direction {
  unsigned s, a;
  std::array<std::uint32_t, 7> m;
};

constexpr std::array<Direction, kMostSobolDimensions - 1> kDirections{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
}};

constexpr unsigned kBits = 32;
using Numbers = std::array<std::uint32_t, kBits>;

Numbers numbers_of(std::size_t dimension) {
  Numbers v{};
  if (dimension == 0) {
    for (unsigned i = 0; i < kBits; ++i) v[i] = 1U << (kBits - 1 - i);
    return v;
  }
  const auto& [s, a, m] = kDirections.at(dimension - 1);
  for (unsigned i = 0; i < kBits; ++i) {
    if (i < s) {
      v[i] = m[i] << (kBits - 1 - i);
      continue;
    }
    v[i] = v[i - s] ^ (v[i - s] >> s);
    for (unsigned k = 1; k < s; ++k) {
      if (((a >> (s - 1 - k)) & 1U) != 0) v[i] ^= v[i - k];
    }
  }
  return v;
}

}  // namespace

LatinHypercube::LatinHypercube(std::uint64_t seed, std::uint32_t points, std::size_t dimensions)
    : seed_(seed) {
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::vector<std::uint32_t>& order = interval_.emplace_back(points);
    std::iota(order.begin(), order.end(), 0U);
    for (std::uint32_t k = points; k > 1; --k) {
      const double u = uniform({seed, k}, static_cast<std::uint32_t>(d), kOrder);
      std::swap(order[k - 1], order[static_cast<std::size_t>(u * k)]);
    }
  }
}

double LatinHypercube::at(std::uint32_t point, std::size_t dimension) const {
  const double within = uniform({seed_, point}, static_cast<std::uint32_t>(dimension), kPlace);
  return (interval_[dimension][point] + within) / static_cast<double>(interval_[dimension].size());
}

double sobol(std::uint32_t point, std::size_t dimension) {
  static const auto numbers = [] {
    std::array<Numbers, kMostSobolDimensions> all{};
    for (std::size_t d = 0; d < all.size(); ++d) all[d] = numbers_of(d);
    return all;
  }();
  const std::uint32_t gray = point ^ (point >> 1);
  std::uint32_t x = 0;
  for (unsigned i = 0; i < kBits; ++i) {
    if (((gray >> i) & 1U) != 0) x ^= numbers.at(dimension)[i];
  }
  return x * 0x1p-32;
}

}  // namespace oblique::ensemble
