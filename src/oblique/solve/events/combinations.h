// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace oblique::solve {

/// A combination of two sides each, a bit for each place. Not installed.
using Combination = std::uint32_t;

inline bool has(Combination combination, std::size_t place) {
  return (combination >> place & 1U) != 0;
}

/// All combinations of so many places, those that differ in the fewest from `to` first.
std::vector<Combination> nearest_first(Combination to, std::size_t places);

}  // namespace oblique::solve
