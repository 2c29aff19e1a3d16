// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/draw/layout/layout.h>

/// The steps of `lay_out`. Layer k holds boxes side by side, one above the other; channel k lies left of it
/// and holds the vertical pieces of wires. Not installed.
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

/// The layer of each node: signals go to the right but for the few wires that close loops.
std::vector<std::size_t> assign_layers(const LayoutGraph& graph);

/// Gives every net its way through the layers.
Plan make_plan(const LayoutGraph& graph, const std::vector<std::size_t>& layers);

/// Orders the slots of each layer so that few wires cross.
void reduce_crossings(Plan& plan);

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

/// Gives every slot its y so that wires run straight where they can.
void place_slots(Plan& plan);

/// Moves boxes and long wires one by one where that takes bends away; their order stays. Part of
/// `place_slots`.
void straighten(Plan& plan);

/// Where the vertical pieces of the wires of one channel stand.
struct Track {
  std::size_t branch = 0;  ///< of the channel
  std::size_t column = 0;  ///< counted from the left
  /// A branch that could not do with one vertical piece goes on at `link` [px] to the piece at `second`.
  bool split = false;
  std::size_t second = 0;
  double link = 0;
};
struct RoutedChannel {
  std::vector<Track> tracks;  ///< of the branches that do not run straight
  std::size_t columns = 0;
};
RoutedChannel route_channel(const Plan& plan, const std::vector<Branch>& branches);

/// All these steps, one after the other; nothing of the result's quality is measured yet.
DiagramLayout lay_out_in_layers(const LayoutGraph& graph);

/// y of a pin.
inline double y_of(const Plan& plan, const Pin& pin) {
  return plan.slots[pin.slot].y + pin.offset;
}

}  // namespace oblique::draw::layered
