// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/nudge.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <oblique/draw/layout/route_all.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr double kFarthest = 8 * kLayoutGrid;      // that a box moves at once
constexpr double kBetweenBoxes = 2 * kLayoutGrid;  // between boxes
constexpr int kNudges = 3;
constexpr double kMostNudging = 3e6;  // points of the grids set up and of searches: about a tenth of a second

class Nudge {
 public:
  Nudge(const LayoutGraph& graph, DiagramLayout& layout, const RoutingArea& area)
      : graph_(graph), layout_(layout), area_(area), nets_at_(graph.nodes.size()) {
    for (std::size_t n = 0; n < layout.nets.size(); ++n) nets_at_[layout.nets[n].from].insert(n);
    for (const LayoutWire& wire : graph.wires) nets_at_[wire.to].insert(net_of(wire));
    const Vector2d lines = (area.high - area.low) / kLayoutGrid;
    work_of_trial_ = lines.x() * lines.y();
  }

  void run() {
    bool better = true;
    for (int round = 0; better && round < kNudges; ++round) {
      better = false;
      for (std::size_t v = 0; v < graph_.nodes.size(); ++v) {
        if (graph_.nodes[v].rank != LayoutRank::free) continue;
        for (const double shift : shifts_of(v)) {
          if (!is_clear(v, shift)) continue;
          work_ += work_of_trial_;
          if (work_ > kMostNudging) return;
          if (!move(v, shift)) continue;
          better = true;
          break;
        }
      }
    }
  }

 private:
  std::size_t net_of(const LayoutWire& wire) const {
    const auto net = std::find_if(layout_.nets.begin(), layout_.nets.end(), [&](const RoutedNet& n) {
      return n.from == wire.from && n.output == wire.output;
    });
    return static_cast<std::size_t>(net - layout_.nets.begin());
  }

  /// How far up or down a wire of the box would be straight; the nearest first.
  std::vector<double> shifts_of(std::size_t v) const {
    std::vector<double> shifts;
    for (const LayoutWire& wire : graph_.wires) {
      if ((wire.from == v) == (wire.to == v)) continue;
      const LayoutNode& from = graph_.nodes[wire.from];
      if (layout_.corners[wire.from].x() + from.size.x() > layout_.corners[wire.to].x()) continue;
      const double rise = layout_.corners[wire.to].y() + graph_.nodes[wire.to].inputs[wire.input] -
                          layout_.corners[wire.from].y() - from.outputs[wire.output];
      if (rise != 0 && std::abs(rise) <= kFarthest) shifts.push_back(wire.from == v ? rise : -rise);
    }
    std::sort(shifts.begin(), shifts.end(), [](double a, double b) {
      return std::abs(a) != std::abs(b) ? std::abs(a) < std::abs(b) : a < b;
    });
    shifts.erase(std::unique(shifts.begin(), shifts.end()), shifts.end());
    return shifts;
  }

  /// Whether the box finds room there, clear of the others and of wires that are not its own.
  bool is_clear(std::size_t v, double shift) const {
    const Vector2d low = layout_.corners[v] + Vector2d(0, shift), high = low + graph_.nodes[v].size;
    if (low.y() < area_.low.y() || high.y() > area_.high.y()) return false;
    const auto touches = [&](const Vector2d& from, const Vector2d& to, double gap) {
      return from.x() <= high.x() && low.x() <= to.x() && from.y() < high.y() + gap && low.y() - gap < to.y();
    };
    for (std::size_t u = 0; u < graph_.nodes.size(); ++u) {
      if (u != v && touches(layout_.corners[u], layout_.corners[u] + graph_.nodes[u].size, kBetweenBoxes))
        return false;
    }
    for (std::size_t n = 0; n < layout_.nets.size(); ++n) {
      if (nets_at_[v].contains(n)) continue;
      for (const WirePiece& piece : layout_.nets[n].pieces) {
        if (touches(piece.from, piece.to, kLayoutGrid)) return false;
      }
    }
    return true;
  }

  int cost_at(const WireRouter& router, std::size_t v) const {
    int cost = 0;
    for (const std::size_t n : nets_at_[v]) cost += router.cost(n);
    return cost;
  }

  /// Moves a box and lays its wires anew, if they are better then.
  bool move(std::size_t v, double shift) {
    std::vector<RoutedNet> old = layout_.nets;
    const int before =
        cost_at(WireRouter(graph_, layout_.corners, nets_of(graph_, layout_.corners, old), area_), v);
    layout_.corners[v].y() += shift;
    for (const std::size_t n : nets_at_[v]) layout_.nets[n].pieces.clear();
    WireRouter trial(graph_, layout_.corners, nets_of(graph_, layout_.corners, layout_.nets), area_);
    const bool found =
        std::all_of(nets_at_[v].begin(), nets_at_[v].end(), [&](std::size_t n) { return trial.route(n); });
    work_ += static_cast<double>(trial.work());
    if (found && cost_at(trial, v) < before) {
      for (const std::size_t n : nets_at_[v]) layout_.nets[n].pieces = trial.net(n).pieces;
      return true;
    }
    layout_.corners[v].y() -= shift;
    layout_.nets = std::move(old);
    return false;
  }

  const LayoutGraph& graph_;
  DiagramLayout& layout_;
  RoutingArea area_;
  std::vector<std::set<std::size_t>> nets_at_;  ///< those with a pin at a box
  double work_of_trial_ = 0, work_ = 0;
};

}  // namespace

void nudge(const LayoutGraph& graph, DiagramLayout& layout, const Eigen::Vector2d& size) {
  Nudge(graph, layout, {Vector2d::Zero(), size}).run();
}

}  // namespace oblique::draw
