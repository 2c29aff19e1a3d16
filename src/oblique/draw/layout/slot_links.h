// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/draw/layout/plan.h>

/// What pulls at a slot, and how near it may come to the next.
namespace oblique::draw::layered {

/// A wire between two slots of neighbouring layers, seen from one of them.
struct SlotLink {
  std::size_t other = 0;
  double shift = 0;  ///< the wire is straight where the slot is at the other's y plus this
  double weight = 1;
  bool before = false;     ///< the other stands in the layer before
  bool same_side = false;  ///< both stand in one layer: the wire turns back
};
/// Those of each slot.
std::vector<std::vector<SlotLink>> links_of(const Plan& plan);

/// From the upper edge of a slot to that of the one below it, at least [px].
double distance(const Plan& plan, std::size_t upper, std::size_t lower);

}  // namespace oblique::draw::layered
