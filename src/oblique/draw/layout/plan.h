// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <oblique/draw/layout/layout.h>

/// What the steps of a layered layout work on. Layer k holds boxes side by side, one above the other; channel
/// k lies left of it and holds the vertical pieces of wires. Not installed.
namespace oblique::draw::layered {

/// What takes a place in a layer: a box, or a net that passes by on its way.
struct Slot {
  static constexpr std::size_t kPassing = static_cast<std::size_t>(-1);
  std::size_t node = kPassing;
  std::size_t net = 0;  ///< of what passes
  std::size_t layer = 0;
  double height = 0;
  double y = 0;  ///< of the upper edge
  bool passes() const { return node == kPassing; }
};

/// An end of a net in a channel.
struct Pin {
  std::size_t slot = 0;
  double offset = 0;  ///< below the upper edge of the slot
  bool left = false;  ///< on the left side of the channel: the slot stands in the layer before it
};

/// A net in a channel; the signal comes from the first pin.
struct Branch {
  std::size_t net = 0;
  std::vector<Pin> pins;
  int weight = 1;
};

/// A graph with a layer for each box and a way through the layers for each net.
struct Plan {
  std::vector<Slot> slots;                                ///< those of the nodes first
  std::vector<std::vector<std::size_t>> layers;           ///< slots from top to bottom
  std::vector<std::vector<Branch>> channels;              ///< one more than layers
  std::vector<std::pair<std::size_t, std::size_t>> nets;  ///< node and output
  std::size_t feedbacks = 0;
};

/// Gives every net its way through the layers: a slot in each that it passes, a branch in each channel.
Plan make_plan(const LayoutGraph& graph, const std::vector<std::size_t>& layers);

/// y of a pin.
inline double y_of(const Plan& plan, const Pin& pin) {
  return plan.slots[pin.slot].y + pin.offset;
}

}  // namespace oblique::draw::layered
