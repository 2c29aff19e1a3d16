// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace oblique::ensemble {

/// Random bits that depend on a counter and a key alone, so that any of them can be had in any order and by
/// any thread: Philox 4×32 with 10 rounds (Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as
/// 1, 2, 3", SC 2011).
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// Which run of which experiment draws.
struct DrawKey {
  std::uint64_t seed = 1;
  std::uint64_t run = 0;
};

/// Uniform in [0, 1), of a key and of two numbers that say what draws.
double uniform(const DrawKey& key, std::uint32_t which, std::uint32_t what);

}  // namespace oblique::ensemble
