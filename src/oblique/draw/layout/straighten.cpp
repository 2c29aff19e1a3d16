// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/straighten.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <oblique/draw/layout/slot_links.h>

// Why this after the sweeps: they move one layer at a time, so a net that passes several layers moves only
// if each of its slots gains by itself; and the sum of distances, which they make least, does not know that
// a bend is a bend however small it is. Here a unit moves as a whole, a box or as much of a passing net as
// has room at one height, to whichever of the heights that its wires propose costs least, with a price on
// each bend. Only what lies between its neighbours is tried, so that the order stays; and only what is
// better is taken, so that it ends.

namespace oblique::draw::layered {
namespace {

constexpr int kStraightenings = 12;
constexpr double kCostOfBend = 48;  // a bend is as bad as a way of this length [px]

/// What is moved as a whole: a box, or the places of a passing net in several layers.
using Unit = std::vector<std::size_t>;

class Straightener {
 public:
  explicit Straightener(Plan& plan)
      : plan_(plan), links_(links_of(plan)), above_(plan.slots.size(), kNone), below_(above_) {
    for (const auto& layer : plan.layers) {
      for (std::size_t k = 1; k < layer.size(); ++k) {
        above_[layer[k]] = layer[k - 1];
        below_[layer[k - 1]] = layer[k];
      }
    }
    find_chains();
  }

  void run() {
    for (int round = 0; round < kStraightenings; ++round) {
      bool better = false;
      for (const Unit& chain : chains_) {
        for (std::size_t first = 0; first < chain.size(); ++first)
          better = straighten(chain, first) || better;
      }
      for (std::size_t s = 0; s < plan_.slots.size(); ++s) {
        if (!plan_.slots[s].passes()) better = move({s}) || better;
      }
      if (!better) break;
    }
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// The places of a net that passes several layers, from left to right.
  void find_chains() {
    std::vector<std::size_t> next(plan_.slots.size(), kNone);
    std::vector<bool> is_first(plan_.slots.size(), true);
    for (const auto& channel : plan_.channels) {
      for (const Branch& branch : channel) {
        const Pin& from = branch.pins[0];
        if (!plan_.slots[from.slot].passes()) continue;
        for (const Pin& to : branch.pins) {
          if (!plan_.slots[to.slot].passes() || to.left == from.left) continue;
          const auto [left, right] =
              from.left ? std::pair(from.slot, to.slot) : std::pair(to.slot, from.slot);
          next[left] = right;
          is_first[right] = false;
        }
      }
    }
    for (std::size_t s = 0; s < plan_.slots.size(); ++s) {
      if (!plan_.slots[s].passes() || !is_first[s]) continue;
      Unit chain;
      for (std::size_t at = s; at != kNone; at = next[at]) chain.push_back(at);
      chains_.push_back(std::move(chain));
    }
  }

  /// Lowest and highest y that leave its neighbours where they are.
  std::pair<double, double> room(std::size_t slot) const {
    double low = std::numeric_limits<double>::lowest(), high = std::numeric_limits<double>::max();
    if (above_[slot] != kNone) low = plan_.slots[above_[slot]].y + distance(plan_, above_[slot], slot);
    if (below_[slot] != kNone) high = plan_.slots[below_[slot]].y - distance(plan_, slot, below_[slot]);
    return {low, high};
  }

  /// Takes as many places of a chain as can have one height, from `first` on, and moves them there.
  bool straighten(const Unit& chain, std::size_t first) {
    auto [low, high] = room(chain[first]);
    Unit unit{chain[first]};
    for (std::size_t k = first + 1; k < chain.size(); ++k) {
      const auto [lowest, highest] = room(chain[k]);
      if (std::max(low, lowest) > std::min(high, highest)) break;
      low = std::max(low, lowest);
      high = std::min(high, highest);
      unit.push_back(chain[k]);
    }
    return move(unit);
  }

  double cost(const Unit& unit) const {
    double sum = 0;
    for (const std::size_t s : unit) {
      for (const SlotLink& link : links_[s]) {
        const double off = std::abs(plan_.slots[link.other].y + link.shift - plan_.slots[s].y);
        sum += link.weight * off + (off > 0 && !link.same_side ? kCostOfBend : 0);
      }
    }
    return sum;
  }

  /// Moves a unit to one height where its wires are better; false where there is no such height.
  bool move(const Unit& unit) {
    double low = std::numeric_limits<double>::lowest(), high = std::numeric_limits<double>::max();
    std::set<double> heights;
    std::vector<double> old;
    for (const std::size_t s : unit) {
      const auto [lowest, highest] = room(s);
      low = std::max(low, lowest);
      high = std::min(high, highest);
      old.push_back(plan_.slots[s].y);
      heights.insert(plan_.slots[s].y);
      for (const SlotLink& link : links_[s]) heights.insert(plan_.slots[link.other].y + link.shift);
    }
    if (low > high) return false;
    double least = cost(unit);
    bool found = false;
    double best = 0;
    for (const double wanted : heights) {
      const double y = std::clamp(wanted, low, high);
      for (const std::size_t s : unit) plan_.slots[s].y = y;
      const double here = cost(unit);
      if (here >= least - 1e-9) continue;
      least = here;
      best = y;
      found = true;
    }
    for (std::size_t k = 0; k < unit.size(); ++k) plan_.slots[unit[k]].y = found ? best : old[k];
    return found;
  }

  Plan& plan_;
  std::vector<std::vector<SlotLink>> links_;
  std::vector<std::size_t> above_, below_;  ///< neighbours in the layer
  std::vector<Unit> chains_;
};

}  // namespace

void straighten(Plan& plan) {
  Straightener(plan).run();
}

}  // namespace oblique::draw::layered
