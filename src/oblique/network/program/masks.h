// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include <oblique/network/assembly/network.h>

namespace oblique::network {

/// A discrete state that makes nothing of another one while it has this value: in `out > limit and drive > 0`
/// the first comparison of the second, while it does not hold.
struct Mask {
  std::uint32_t discrete_state = 0;
  double value = 0;
  auto operator<=>(const Mask&) const = default;
};

/// Of each of these nodes what masks it: as long as any of its masks has its value, nothing that the network
/// reads depends on the node. Ascending.
std::vector<std::vector<Mask>> find_masks(const Network& network, const std::vector<NodeId>& nodes);

}  // namespace oblique::network
