// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/route_all.h>

#include <algorithm>
#include <map>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr int kRoutings = 4;
/// Points to look at in order to improve a layout: about a tenth of a second.
constexpr long kMostRouting = 300'000;

}  // namespace

std::vector<NetToRoute> nets_of(const LayoutGraph& graph, const std::vector<Vector2d>& corners,
                                std::vector<RoutedNet>& routed) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Vector2d>> sinks;
  for (const LayoutWire& wire : graph.wires) {
    sinks[{wire.from, wire.output}].push_back(corners[wire.to] +
                                              Vector2d(0, graph.nodes[wire.to].inputs[wire.input]));
  }
  if (routed.empty()) {
    for (const auto& [pin, ends] : sinks) routed.push_back({pin.first, pin.second, {}, {}});
  }
  std::vector<NetToRoute> nets;
  for (const RoutedNet& net : routed) {
    const LayoutNode& node = graph.nodes[net.from];
    nets.push_back({corners[net.from] + Vector2d(node.size.x(), node.outputs[net.output]),
                    sinks.at({net.from, net.output}), net.pieces});
  }
  return nets;
}

void improve(WireRouter& router, const std::vector<std::size_t>& order) {
  const long most = router.work() + kMostRouting;
  bool better = true;
  for (int round = 0; better && round < kRoutings; ++round) {
    better = false;
    for (const std::size_t k : order) {
      if (router.work() > most) return;
      better = (!router.net(k).pieces.empty() && router.route(k)) || better;
    }
  }
}

std::vector<std::size_t> route_all(const LayoutGraph& graph, const std::vector<Vector2d>& corners,
                                   const RoutingArea& area, std::vector<NetToRoute>& nets) {
  // short nets first: they have the least choice
  std::vector<std::size_t> order(nets.size());
  std::vector<double> spread;
  for (std::size_t k = 0; k < nets.size(); ++k) {
    order[k] = k;
    double farthest = 0;
    for (const Vector2d& sink : nets[k].sinks)
      farthest = std::max(farthest, (sink - nets[k].source).lpNorm<1>());
    spread.push_back(farthest);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return spread[a] < spread[b]; });
  std::vector<std::size_t> lost;
  for (int attempt = 0; attempt < kRoutings; ++attempt) {
    WireRouter router(graph, corners, nets, area);
    lost.clear();
    for (const std::size_t k : order) {
      if (nets[k].pieces.empty() && !router.route(k)) lost.push_back(k);
    }
    if (!lost.empty() && attempt + 1 < kRoutings) {  // those come first, then
      std::stable_partition(order.begin(), order.end(), [&](std::size_t k) {
        return std::find(lost.begin(), lost.end(), k) != lost.end();
      });
      continue;
    }
    improve(router, order);
    for (std::size_t k = 0; k < nets.size(); ++k) nets[k].pieces = router.net(k).pieces;
    break;
  }
  return lost;
}

}  // namespace oblique::draw
