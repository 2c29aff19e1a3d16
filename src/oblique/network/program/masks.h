// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <oblique/network/assembly/network.h>

namespace oblique::network {

/// A discrete state that makes nothing of another one while it has this value: in `out > limit and drive > 0`
/// the first comparison of the second, while it does not hold.
struct Mask {
  std::uint32_t discrete_state = 0;
  double value = 0;

  bool operator<(const Mask& other) const {
    return std::pair(discrete_state, value) < std::pair(other.discrete_state, other.value);
  }
};

/// Of the position of each switch what masks it: as long as any of its masks has its value, nothing that the
/// network reads depends on the position. Ascending.
std::vector<std::vector<Mask>> find_masks(const Network& network);

/// Whether one of them has its value.
bool is_masked(std::span<const Mask> masks, std::span<const double> discrete_states);

}  // namespace oblique::network
