// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/channel.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

// How vertical pieces share a channel. Every net in it that does not run straight has one vertical piece,
// between its highest and its lowest pin. Two pins of different nets at one height, left and right of the
// channel, would lie on each other's horizontal pieces: the piece of the left one must stand left of the
// other's. So:
//
// 1. These conditions are collected.
// 2. A sequence is built from the left, each time with the piece, of those whose conditions are met, that
//    crosses least. Where the conditions run in a circle, one piece is split into two that a link joins
//    between the rows of the grid.
// 3. Neighbours in the sequence change places where that takes crossings away and no condition forbids it.
// 4. Pieces take columns in this sequence, each the leftmost that is free at its heights.

namespace oblique::draw::layered {
namespace {

/// A vertical piece to be placed: a branch, or one of the two halves of a split one.
struct Vertical {
  std::size_t branch = 0;
  bool second = false;
  std::vector<double> left, right;  ///< y of its pins on either side, and of its link
  double top = 0, bottom = 0;
  std::set<std::size_t> before;  ///< verticals that must stand left of it
};

void measure(Vertical& v) {
  std::vector<double> all = v.left;
  all.insert(all.end(), v.right.begin(), v.right.end());
  const auto [low, high] = std::minmax_element(all.begin(), all.end());
  v.top = *low;
  v.bottom = *high;
}

bool inside(double y, const Vertical& v) {
  return v.top < y && y < v.bottom;
}

/// Crossings of two verticals with each other's wires when `a` stands left of `b`.
long crossings(const Vertical& a, const Vertical& b) {
  return std::count_if(a.right.begin(), a.right.end(), [&](double y) { return inside(y, b); }) +
         std::count_if(b.left.begin(), b.left.end(), [&](double y) { return inside(y, a); });
}

class Router {
 public:
  Router(const Plan& plan, const std::vector<Branch>& branches) : plan_(plan) {
    for (std::size_t b = 0; b < branches.size(); ++b) {
      Vertical v;
      v.branch = b;
      for (const Pin& pin : branches[b].pins) (pin.left ? v.left : v.right).push_back(y_of(plan_, pin));
      measure(v);
      if (v.top < v.bottom) verticals_.push_back(std::move(v));
    }
  }

  RoutedChannel route() {
    constrain();
    sort();
    improve();
    return assign();
  }

 private:
  /// Two wires that meet at one height from both sides: the one from the left turns off first.
  void constrain() {
    std::map<double, std::size_t> from_left;
    for (std::size_t v = 0; v < verticals_.size(); ++v) {
      for (const double y : verticals_[v].left) from_left[y] = v;
    }
    for (std::size_t v = 0; v < verticals_.size(); ++v) {
      for (const double y : verticals_[v].right) {
        const auto found = from_left.find(y);
        if (found != from_left.end() && found->second != v) verticals_[v].before.insert(found->second);
      }
    }
  }

  /// A sequence that keeps the constraints, at every step with the vertical that crosses least; where only
  /// circles of constraints are left, one vertical is split.
  void sort() {
    std::set<std::size_t> placed;
    const auto is_free = [&](std::size_t v) {
      return std::all_of(verticals_[v].before.begin(), verticals_[v].before.end(),
                         [&](std::size_t u) { return placed.contains(u); });
    };
    while (order_.size() < verticals_.size()) {
      std::size_t best = verticals_.size();
      long least = 0;
      for (std::size_t v = 0; v < verticals_.size(); ++v) {
        if (placed.contains(v) || !is_free(v)) continue;
        long cost = 0;
        for (std::size_t u = 0; u < verticals_.size(); ++u) {
          if (u == v || placed.contains(u)) continue;
          cost += crossings(verticals_[v], verticals_[u]) - crossings(verticals_[u], verticals_[v]);
        }
        if (best == verticals_.size() || cost < least) {
          best = v;
          least = cost;
        }
      }
      if (best == verticals_.size()) {
        split(placed);
        continue;
      }
      order_.push_back(best);
      placed.insert(best);
    }
  }

  /// Splits the waiting vertical with the fewest wires: the half with the pins on the left waits for nothing,
  /// and nothing waits for the other, so that no circle needs it split again.
  void split(const std::set<std::size_t>& placed) {
    std::size_t best = verticals_.size();
    for (std::size_t v = 0; v < verticals_.size(); ++v) {
      const Vertical& waiting = verticals_[v];
      if (placed.contains(v) || waiting.second || waiting.left.empty() || waiting.right.empty()) continue;
      if (best == verticals_.size() || size(v) < size(best)) best = v;
    }
    Vertical second;
    second.branch = verticals_[best].branch;
    second.second = true;
    second.right = std::move(verticals_[best].right);
    second.before = std::move(verticals_[best].before);
    second.before.insert(best);
    // between two rows of the grid, where there are no pins
    const double middle = (verticals_[best].top + verticals_[best].bottom) / 2;
    double link = std::floor(middle / kLayoutGrid) * kLayoutGrid + kLayoutGrid / 2;
    for (int k = 1; links_.contains(link); ++k) link += (k % 2 == 0 ? -k : k) * kLayoutGrid;
    links_.insert(link);
    verticals_[best].right = {link};
    verticals_[best].before.clear();
    second.left = {link};
    measure(verticals_[best]);
    measure(second);
    verticals_.push_back(std::move(second));
  }

  std::size_t size(std::size_t v) const { return verticals_[v].left.size() + verticals_[v].right.size(); }

  /// Swaps neighbours where that takes crossings away and nothing forbids it.
  void improve() {
    bool better = true;
    for (int round = 0; better && round < 20; ++round) {
      better = false;
      for (std::size_t k = 0; k + 1 < order_.size(); ++k) {
        const Vertical& a = verticals_[order_[k]];
        const Vertical& b = verticals_[order_[k + 1]];
        if (b.before.contains(order_[k]) || crossings(a, b) <= crossings(b, a)) continue;
        std::swap(order_[k], order_[k + 1]);
        better = true;
      }
    }
  }

  /// The leftmost column that each may have; pieces apart from each other share one.
  RoutedChannel assign() const {
    RoutedChannel channel;
    std::vector<std::size_t> column(verticals_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const Vertical& v = verticals_[order_[k]];
      for (std::size_t j = 0; j < k; ++j) {
        const Vertical& u = verticals_[order_[j]];
        const bool apart = u.bottom + kLayoutGrid / 2 < v.top || v.bottom + kLayoutGrid / 2 < u.top;
        if (!apart || v.before.contains(order_[j]))
          column[order_[k]] = std::max(column[order_[k]], column[order_[j]] + 1);
      }
      channel.columns = std::max(channel.columns, column[order_[k]] + 1);
    }
    for (std::size_t v = 0; v < verticals_.size(); ++v) {
      if (!verticals_[v].second) {
        channel.tracks.push_back({verticals_[v].branch, column[v]});
        continue;
      }
      const auto first = std::find_if(channel.tracks.begin(), channel.tracks.end(),
                                      [&](const Track& t) { return t.branch == verticals_[v].branch; });
      first->split = true;
      first->second = column[v];
      first->link = verticals_[v].left.front();
    }
    return channel;
  }

  const Plan& plan_;
  std::set<double> links_;
  std::vector<Vertical> verticals_;
  std::vector<std::size_t> order_;
};

}  // namespace

RoutedChannel route_channel(const Plan& plan, const std::vector<Branch>& branches) {
  return Router(plan, branches).route();
}

}  // namespace oblique::draw::layered
