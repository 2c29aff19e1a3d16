// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/layering.h>

#include <algorithm>
#include <limits>
#include <numeric>

// How boxes come into layers. Signals are to run from left to right, but a diagram with feedback has loops,
// so some wires must run back. The fewer, the easier it is to read; to find the fewest is NP-hard. So:
//
// 1. Two sequences of the boxes are made: one that follows the signals from their sources, and one by the
//    heuristic of Eades, Lin and Smyth. The one with less weight of wires running back is taken; the wires
//    that run back in it are left out from here on. What remains has no loop.
// 2. Each box goes into the layer after the last one that feeds it (longest way), which gives the fewest
//    layers.
// 3. Boxes that have room to move go to where their wires are shortest, until none moves (thirty rounds at
// most).
// 4. Wide boxes go into layers that are wide already; terminals go to the two ends.

namespace oblique::draw::layered {
namespace {

constexpr int kLayerSweeps = 30;

struct Arc {
  std::size_t from, to;
  int weight;
};

/// The wires between different boxes, each pair of boxes once with the weights added.
std::vector<Arc> arcs_of(const LayoutGraph& graph) {
  std::vector<Arc> arcs;
  for (const LayoutWire& wire : graph.wires) {
    if (wire.from != wire.to) arcs.push_back({wire.from, wire.to, wire.weight});
  }
  std::sort(arcs.begin(), arcs.end(),
            [](const Arc& a, const Arc& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
  std::vector<Arc> merged;
  for (const Arc& arc : arcs) {
    if (!merged.empty() && merged.back().from == arc.from && merged.back().to == arc.to) {
      merged.back().weight += arc.weight;
    } else {
      merged.push_back(arc);
    }
  }
  return merged;
}

/// A sequence of the nodes in which few arcs go back (P. Eades, X. Lin, W. Smyth, "A fast and effective
/// heuristic for the feedback arc set problem", 1993): sources to the front, sinks to the back, and where
/// there are only loops, the node with most arcs out over those in comes next.
std::vector<std::size_t> sequence(std::size_t n, const std::vector<Arc>& arcs) {
  std::vector<std::vector<std::size_t>> out(n), in(n);
  std::vector<int> out_weight(n), in_weight(n);
  for (std::size_t a = 0; a < arcs.size(); ++a) {
    out[arcs[a].from].push_back(a);
    in[arcs[a].to].push_back(a);
    out_weight[arcs[a].from] += arcs[a].weight;
    in_weight[arcs[a].to] += arcs[a].weight;
  }
  std::vector<bool> taken(n);
  std::vector<std::size_t> front, back;
  const auto take = [&](std::size_t v) {
    taken[v] = true;
    for (const std::size_t a : out[v]) in_weight[arcs[a].to] -= arcs[a].weight;
    for (const std::size_t a : in[v]) out_weight[arcs[a].from] -= arcs[a].weight;
  };
  for (std::size_t left = n; left > 0;) {
    bool found = true;
    while (found) {
      found = false;
      for (std::size_t v = 0; v < n; ++v) {
        if (taken[v] || (out_weight[v] != 0 && in_weight[v] != 0)) continue;
        (in_weight[v] == 0 ? front : back).push_back(v);
        take(v);
        --left;
        found = true;
      }
    }
    if (left == 0) break;
    std::size_t best = n;
    for (std::size_t v = 0; v < n; ++v) {
      if (taken[v]) continue;
      if (best == n || out_weight[v] - in_weight[v] > out_weight[best] - in_weight[best]) best = v;
    }
    front.push_back(best);
    take(best);
    --left;
  }
  front.insert(front.end(), back.rbegin(), back.rend());
  return front;
}

/// A sequence that follows the signals from the sources on: what is met again on the way closes a loop.
std::vector<std::size_t> signal_sequence(std::size_t n, const std::vector<Arc>& arcs) {
  std::vector<std::vector<std::size_t>> out(n);
  std::vector<int> in(n);
  for (const Arc& arc : arcs) {
    out[arc.from].push_back(arc.to);
    ++in[arc.to];
  }
  std::vector<std::size_t> starts(n);
  std::iota(starts.begin(), starts.end(), std::size_t{0});
  std::stable_partition(starts.begin(), starts.end(), [&](std::size_t v) { return in[v] == 0; });
  std::vector<bool> seen(n);
  std::vector<std::size_t> finished;
  std::vector<std::pair<std::size_t, std::size_t>> stack;
  for (const std::size_t start : starts) {
    if (seen[start]) continue;
    seen[start] = true;
    stack.emplace_back(start, 0);
    while (!stack.empty()) {
      const std::size_t v = stack.back().first;
      if (stack.back().second == out[v].size()) {
        finished.push_back(v);
        stack.pop_back();
        continue;
      }
      const std::size_t next = out[v][stack.back().second++];
      if (seen[next]) continue;
      seen[next] = true;
      stack.emplace_back(next, 0);
    }
  }
  return {finished.rbegin(), finished.rend()};
}

std::vector<std::size_t> positions_of(const std::vector<std::size_t>& sequence) {
  std::vector<std::size_t> position(sequence.size());
  for (std::size_t k = 0; k < sequence.size(); ++k) position[sequence[k]] = k;
  return position;
}

int weight_back(const std::vector<Arc>& arcs, const std::vector<std::size_t>& position) {
  int weight = 0;
  for (const Arc& arc : arcs) {
    if (position[arc.from] > position[arc.to]) weight += arc.weight;
  }
  return weight;
}

/// Layers by the longest way from a source, then every node moves to where its arcs are shortest.
std::vector<std::size_t> layers_of(std::size_t n, const std::vector<Arc>& forward,
                                   const std::vector<std::size_t>& sequence) {
  std::vector<std::vector<std::size_t>> out(n), in(n);
  for (std::size_t a = 0; a < forward.size(); ++a) {
    out[forward[a].from].push_back(a);
    in[forward[a].to].push_back(a);
  }
  std::vector<std::size_t> layer(n);
  for (const std::size_t v : sequence) {
    for (const std::size_t a : in[v]) layer[v] = std::max(layer[v], layer[forward[a].from] + 1);
  }
  for (int round = 0; round < kLayerSweeps; ++round) {
    bool moved = false;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t v = sequence[round % 2 == 0 ? n - 1 - k : k];
      std::size_t low = 0, high = std::numeric_limits<std::size_t>::max();
      int pull = 0;  // to the right
      for (const std::size_t a : in[v]) {
        low = std::max(low, layer[forward[a].from] + 1);
        pull -= forward[a].weight;
      }
      for (const std::size_t a : out[v]) {
        high = std::min(high, layer[forward[a].to] - 1);
        pull += forward[a].weight;
      }
      const std::size_t wanted = pull > 0 && !out[v].empty() ? high : pull < 0 ? low : layer[v];
      moved = moved || wanted != layer[v];
      layer[v] = wanted;
    }
    if (!moved) break;
  }
  return layer;
}

/// Moves wide boxes, which are open composites, into layers that are wide already where they have the choice:
/// the picture becomes narrower.
void share_widths(const LayoutGraph& graph, const std::vector<Arc>& forward,
                  std::vector<std::size_t>& layer) {
  constexpr double kWide = 320;  // [px]
  constexpr double kWire = 24;   // a wire longer by a layer is as bad as a picture wider by this [px]
  struct Wide {
    std::size_t node, low, high;
    int pull = 0;  // to the left
  };
  const std::size_t n = graph.nodes.size(), layers = *std::max_element(layer.begin(), layer.end()) + 1;
  std::vector<double> widths(layers);
  std::vector<Wide> wide;
  for (std::size_t v = 0; v < n; ++v) {
    const LayoutNode& node = graph.nodes[v];
    Wide w{v, 0, layers - 1};
    for (const Arc& arc : forward) {
      if (arc.from == v) w.high = std::min(w.high, layer[arc.to] - 1);
      if (arc.to == v) w.low = std::max(w.low, layer[arc.from] + 1);
      if (arc.from == v || arc.to == v) w.pull += arc.from == v ? -arc.weight : arc.weight;
    }
    if (node.rank == LayoutRank::free && node.size.x() > kWide && w.low < w.high) {
      wide.push_back(w);
    } else {
      widths[layer[v]] = std::max(widths[layer[v]], node.size.x());
    }
  }
  std::stable_sort(wide.begin(), wide.end(), [&](const Wide& a, const Wide& b) {
    return graph.nodes[a.node].size.x() > graph.nodes[b.node].size.x();
  });
  for (Wide& w : wide) {
    for (const Arc& arc : forward) {  // others may have moved
      if (arc.from == w.node) w.high = std::min(w.high, layer[arc.to] - 1);
      if (arc.to == w.node) w.low = std::max(w.low, layer[arc.from] + 1);
    }
    const double width = graph.nodes[w.node].size.x();
    const auto cost = [&](std::size_t l) {
      return std::max(0.0, width - widths[l]) + kWire * w.pull * static_cast<double>(l);
    };
    std::size_t& best = layer[w.node];
    for (std::size_t l = w.low; l <= w.high; ++l) {
      if (cost(l) < cost(best)) best = l;
    }
    widths[best] = std::max(widths[best], width);
  }
}

}  // namespace

std::vector<std::size_t> assign_layers(const LayoutGraph& graph) {
  const std::size_t n = graph.nodes.size();
  if (n == 0) return {};
  const std::vector<Arc> arcs = arcs_of(graph);
  std::vector<std::size_t> order = signal_sequence(n, arcs);
  const std::vector<std::size_t> other = sequence(n, arcs);
  if (weight_back(arcs, positions_of(other)) < weight_back(arcs, positions_of(order))) order = other;
  const std::vector<std::size_t> position = positions_of(order);
  std::vector<Arc> forward;
  for (const Arc& arc : arcs) {
    if (position[arc.from] < position[arc.to]) forward.push_back(arc);
  }
  std::vector<std::size_t> layer = layers_of(n, forward, order);
  share_widths(graph, forward, layer);
  const bool has_first = std::any_of(graph.nodes.begin(), graph.nodes.end(),
                                     [](const LayoutNode& node) { return node.rank == LayoutRank::first; });
  std::size_t least = std::numeric_limits<std::size_t>::max(), most = 0;
  for (std::size_t v = 0; v < n; ++v) {
    if (graph.nodes[v].rank != LayoutRank::free) continue;
    least = std::min(least, layer[v]);
    most = std::max(most, layer[v]);
  }
  if (least > most) least = most = 0;
  for (std::size_t v = 0; v < n; ++v) {
    const std::size_t offset = has_first ? 1 : 0;
    switch (graph.nodes[v].rank) {
      case LayoutRank::free:
        layer[v] = layer[v] - least + offset;
        break;
      case LayoutRank::first:
        layer[v] = 0;
        break;
      case LayoutRank::last:
        layer[v] = most - least + offset + 1;
        break;
    }
  }
  return layer;
}

}  // namespace oblique::draw::layered
