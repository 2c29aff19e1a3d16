// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/layered_layout.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <oblique/draw/layout/channel.h>
#include <oblique/draw/layout/layering.h>
#include <oblique/draw/layout/ordering.h>
#include <oblique/draw/layout/placement.h>
#include <oblique/draw/layout/plan.h>
#include <oblique/draw/schematic/wire_pieces.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using layered::Branch;
using layered::Pin;
using layered::Plan;
using layered::RoutedChannel;
using layered::Slot;

constexpr double kChannelMargin = kLayoutGrid;

/// x of the layers' columns and of the channels between them.
struct Columns {
  std::vector<double> left, right;  ///< of each layer
  std::vector<double> channel;      ///< left side of each channel
  double width = 0;
};

Columns columns_of(const LayoutGraph& graph, const Plan& plan, const std::vector<RoutedChannel>& channels) {
  Columns columns;
  double x = 0;
  const auto add_channel = [&](std::size_t c) {
    columns.channel.push_back(x);
    const bool outside = c == 0 || c + 1 == channels.size();
    if (outside && channels[c].columns == 0) return;
    x += 2 * kChannelMargin +
         static_cast<double>(std::max<std::size_t>(channels[c].columns, 1) - 1) * kLayoutGrid;
  };
  for (std::size_t l = 0; l < plan.layers.size(); ++l) {
    add_channel(l);
    double width = 0;
    for (const std::size_t s : plan.layers[l]) {
      if (!plan.slots[s].passes()) width = std::max(width, graph.nodes[plan.slots[s].node].size.x());
    }
    columns.left.push_back(x);
    columns.right.push_back(x += width);
  }
  add_channel(plan.layers.size());
  columns.width = x;
  return columns;
}

/// The wires of all nets as pieces, from the columns that the channels were given.
class Drafter {
 public:
  Drafter(const LayoutGraph& graph, const Plan& plan, const std::vector<RoutedChannel>& channels,
          const Columns& columns, DiagramLayout& layout)
      : graph_(graph), plan_(plan), columns_(columns), layout_(layout) {
    for (const auto& [node, output] : plan.nets) layout.nets.push_back({node, output, {}, {}});
    for (const Slot& slot : plan.slots) {
      if (slot.passes())
        add(slot.net, {columns.left[slot.layer], slot.y}, {columns.right[slot.layer], slot.y});
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
      std::vector<const layered::Track*> tracks(plan.channels[c].size());
      for (const layered::Track& track : channels[c].tracks) tracks[track.branch] = &track;
      for (std::size_t b = 0; b < tracks.size(); ++b) add_branch(c, plan.channels[c][b], tracks[b]);
    }
    for (RoutedNet& net : layout.nets) net.pieces = merged(std::move(net.pieces));
  }

 private:
  void add(std::size_t net, const Vector2d& a, const Vector2d& b) {
    const bool swap = a.x() > b.x() || a.y() > b.y();
    layout_.nets[net].pieces.push_back(swap ? WirePiece{b, a} : WirePiece{a, b});
  }

  Vector2d end(const Pin& pin) const {
    const Slot& slot = plan_.slots[pin.slot];
    const double y = y_of(plan_, pin);
    if (slot.passes()) return {pin.left ? columns_.right[slot.layer] : columns_.left[slot.layer], y};
    const double left = layout_.corners[slot.node].x();
    return {pin.left ? left + graph_.nodes[slot.node].size.x() : left, y};
  }

  double x_of(std::size_t channel, std::size_t column) const {
    return columns_.channel[channel] + kChannelMargin + static_cast<double>(column) * kLayoutGrid;
  }

  void add_branch(std::size_t channel, const Branch& branch, const layered::Track* track) {
    if (track == nullptr) {
      add(branch.net, end(branch.pins.front()), end(branch.pins.back()));
      for (const Pin& pin : branch.pins) add(branch.net, end(branch.pins.front()), end(pin));
      return;
    }
    const double first = x_of(channel, track->column);
    const double second = track->split ? x_of(channel, track->second) : first;
    std::map<double, std::array<double, 2>> spans;  // of y by x
    const auto reach = [&](double x, double y) {
      const auto [at, is_new] = spans.try_emplace(x, std::array{y, y});
      at->second = {std::min(at->second[0], y), std::max(at->second[1], y)};
    };
    if (track->split) {
      reach(first, track->link);
      reach(second, track->link);
      add(branch.net, {first, track->link}, {second, track->link});
    }
    for (const Pin& pin : branch.pins) {
      const Vector2d at = end(pin);
      const double x = pin.left ? first : second;
      reach(x, at.y());
      add(branch.net, at, {x, at.y()});
    }
    for (const auto& [x, span] : spans) add(branch.net, {x, span[0]}, {x, span[1]});
  }

  const LayoutGraph& graph_;
  const Plan& plan_;
  const Columns& columns_;
  DiagramLayout& layout_;
};

}  // namespace

DiagramLayout layered::lay_out_in_layers(const LayoutGraph& graph) {
  DiagramLayout layout;
  Plan plan = layered::make_plan(graph, layered::assign_layers(graph));
  layered::reduce_crossings(plan);
  layered::place_slots(plan);
  std::vector<RoutedChannel> channels;
  for (const auto& branches : plan.channels) channels.push_back(layered::route_channel(plan, branches));
  const Columns columns = columns_of(graph, plan, channels);
  for (std::size_t v = 0; v < graph.nodes.size(); ++v) {
    const Slot& slot = plan.slots[v];
    const double spare = columns.right[slot.layer] - columns.left[slot.layer] - graph.nodes[v].size.x();
    const double share = graph.nodes[v].rank == LayoutRank::first  ? 0
                         : graph.nodes[v].rank == LayoutRank::last ? 1
                                                                   : 0.5;
    const double indent = std::floor(share * spare / kLayoutGrid) * kLayoutGrid;
    layout.corners.emplace_back(columns.left[slot.layer] + indent, slot.y);
  }
  Drafter(graph, plan, channels, columns, layout);
  return layout;
}

}  // namespace oblique::draw
