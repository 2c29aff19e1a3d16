// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/ordering.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

// How wires come to cross little. The number of crossings follows from the order of the slots in their
// layers alone, before anything has a place; the best order is NP-hard to find even for two layers. So, from
// each of two starts (the order of the file, and the order in which a search along the wires meets the
// slots), sixteen rounds:
//
// 1. A sweep goes through the layers, to the right and to the left in turn, and sorts each by the mean place
//    of what its slots are wired to in the layer before it (barycentre method; Sugiyama, Tagawa, Toda 1981).
// 2. Neighbours change places as long as that takes crossings away: the mean does not see single crossings.
// 3. In the last two rounds, two nets that run side by side through several layers change places in all of
//    them at once: no single swap can undo such a twist, since each one alone makes it worse.
//
// The order with the fewest crossings of all that were met is kept. Ties stay as they are, so that the
// result does not depend on anything but the graph.

namespace oblique::draw::layered {
namespace {

constexpr int kSweeps = 16;

/// Part of a branch: from its first pin to one of the others.
struct Link {
  Pin from, to;
  std::size_t channel;
};

class Ordering {
 public:
  explicit Ordering(Plan& plan)
      : plan_(plan), position_(plan.slots.size()), links_(plan.channels.size()), of_slot_(plan.slots.size()) {
    for (std::size_t c = 0; c < plan.channels.size(); ++c) {
      for (const Branch& branch : plan.channels[c]) {
        for (std::size_t k = 1; k < branch.pins.size(); ++k) {
          const Link link{branch.pins[0], branch.pins[k], c};
          of_slot_[link.from.slot].push_back({c, links_[c].size()});
          of_slot_[link.to.slot].push_back({c, links_[c].size()});
          links_[c].push_back(link);
        }
      }
    }
  }

  void run() {
    std::vector<std::vector<std::size_t>> best;
    std::size_t least = 0;
    for (const bool along_signals : {false, true}) {
      along_signals ? order_along_signals() : order_as_given();
      for (int sweep = 0; sweep < kSweeps; ++sweep) {
        sweep_layers(sweep % 2 == 0);
        transpose();
        if (sweep + 2 >= kSweeps) exchange_nets();
        const std::size_t crossings = count();
        if (!best.empty() && crossings >= least) continue;
        best = plan_.layers;
        least = crossings;
      }
    }
    plan_.layers = best;
  }

 private:
  void number(std::size_t layer) {
    for (std::size_t k = 0; k < plan_.layers[layer].size(); ++k)
      position_[plan_.layers[layer][k]] = static_cast<double>(k);
  }

  void order_as_given() {
    for (std::size_t l = 0; l < plan_.layers.size(); ++l) {
      std::sort(plan_.layers[l].begin(), plan_.layers[l].end());
      number(l);
    }
  }

  /// What is connected comes together: the slots as a search along the wires finds them.
  void order_along_signals() {
    std::vector<std::size_t> rank(plan_.slots.size(), Slot::kPassing);
    std::size_t next = 0;
    std::vector<std::size_t> stack;
    for (std::size_t s = 0; s < plan_.slots.size(); ++s) {
      if (rank[s] != Slot::kPassing) continue;
      stack.push_back(s);
      while (!stack.empty()) {
        const std::size_t at = stack.back();
        stack.pop_back();
        if (rank[at] != Slot::kPassing) continue;
        rank[at] = next++;
        for (const auto& [c, k] : of_slot_[at]) {
          const Link& link = links_[c][k];
          stack.push_back(link.from.slot == at ? link.to.slot : link.from.slot);
        }
      }
    }
    for (std::size_t l = 0; l < plan_.layers.size(); ++l) {
      auto& layer = plan_.layers[l];
      std::sort(layer.begin(), layer.end(), [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });
      number(l);
    }
  }

  /// Where a pin is, in places of its layer.
  double place(const Pin& pin) const {
    const Slot& slot = plan_.slots[pin.slot];
    return position_[pin.slot] + (slot.passes() ? 0.5 : pin.offset / (slot.height + 1));
  }

  /// Sorts each layer by the mean place of what its slots are wired to in the layer before it.
  void sweep_layers(bool to_the_right) {
    const std::size_t n = plan_.layers.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t l = to_the_right ? k : n - 1 - k;
      auto& layer = plan_.layers[l];
      std::vector<std::pair<double, std::size_t>> keys;
      for (const std::size_t s : layer) {
        double sum = 0;
        int count = 0;
        for (const auto& [c, index] : of_slot_[s]) {
          const Link& link = links_[c][index];
          const bool same_side = link.from.left == link.to.left;
          if (!same_side && c != (to_the_right ? l : l + 1)) continue;
          const bool is_from = link.from.slot == s;
          if (is_from && link.to.slot == s) continue;
          const Pin& other = is_from ? link.to : link.from;
          const Pin& own = is_from ? link.from : link.to;
          sum += place(other) - (place(own) - position_[s] - 0.5);
          ++count;
        }
        keys.emplace_back(count > 0 ? sum / count : position_[s] + 0.5, s);
      }
      std::stable_sort(keys.begin(), keys.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
      for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = keys[i].second;
      number(l);
    }
  }

  /// Crossings between the wires of `upper` and `lower` while `upper` stands above, one above the other.
  long crossings_of(std::size_t upper, std::size_t lower) const {
    long crossings = 0;
    for (const auto& [c, i] : of_slot_[upper]) {
      const Link& a = links_[c][i];
      const bool a_from = a.from.slot == upper;
      const Pin& a_other = a_from ? a.to : a.from;
      const bool a_same = a.from.left == a.to.left;
      // a wire that stays on its side and goes on below passes the pins of `lower` on that side
      if (a_same && position_[a_other.slot] > std::max(position_[upper], position_[lower]))
        crossings += pins_on(lower, a_from ? a.from : a.to, c);
      if (a_same) continue;
      for (const auto& [d, j] : of_slot_[lower]) {
        if (c != d) continue;
        const Link& b = links_[d][j];
        if (b.from.left == b.to.left) continue;
        const Pin& b_other = b.from.slot == lower ? b.to : b.from;
        if (a_other.slot == b_other.slot && a_other.offset == b_other.offset) continue;
        if (place(a_other) > place(b_other)) ++crossings;
      }
    }
    for (const auto& [c, i] : of_slot_[lower]) {
      const Link& b = links_[c][i];
      if (b.from.left != b.to.left) continue;
      const bool from = b.from.slot == lower;
      const Pin& other = from ? b.to : b.from;
      if (position_[other.slot] < std::min(position_[upper], position_[lower]))
        crossings += pins_on(upper, from ? b.from : b.to, c);
    }
    return crossings;
  }

  long pins_on(std::size_t slot, const Pin& beside, std::size_t channel) const {
    long pins = 0;
    for (const auto& [c, i] : of_slot_[slot]) {
      if (c != channel) continue;
      const Link& link = links_[c][i];
      const Pin& own = link.from.slot == slot ? link.from : link.to;
      if (own.left == beside.left) ++pins;
    }
    return pins;
  }

  /// Swaps neighbours as long as that takes crossings away.
  void transpose() {
    bool better = true;
    for (int round = 0; better && round < 8; ++round) {
      better = false;
      for (auto& layer : plan_.layers) {
        for (std::size_t k = 0; k + 1 < layer.size(); ++k) {
          if (crossings_of(layer[k], layer[k + 1]) <= crossings_of(layer[k + 1], layer[k])) continue;
          std::swap(layer[k], layer[k + 1]);
          std::swap(position_[layer[k]], position_[layer[k + 1]]);
          better = true;
        }
      }
    }
  }

  /// Where two nets pass several layers side by side, gives them one order all the way if that takes
  /// crossings away: single swaps cannot undo a twist.
  void exchange_nets() {
    std::vector<std::map<std::size_t, std::size_t>> passing(plan_.nets.size());  // slot by layer
    for (std::size_t s = 0; s < plan_.slots.size(); ++s) {
      if (plan_.slots[s].passes()) passing[plan_.slots[s].net][plan_.slots[s].layer] = s;
    }
    const auto side_by_side = [&](std::size_t a, std::size_t b, std::size_t layer) {
      const auto of_a = passing[a].find(layer), of_b = passing[b].find(layer);
      return of_a != passing[a].end() && of_b != passing[b].end() &&
             std::abs(position_[of_a->second] - position_[of_b->second]) == 1;
    };
    for (std::size_t l = 0; l < plan_.layers.size(); ++l) {
      for (std::size_t k = 0; k + 1 < plan_.layers[l].size(); ++k) {
        const Slot& upper = plan_.slots[plan_.layers[l][k]];
        const Slot& lower = plan_.slots[plan_.layers[l][k + 1]];
        if (!upper.passes() || !lower.passes()) continue;
        const std::size_t a = upper.net, b = lower.net;
        if (l > 0 && side_by_side(a, b, l - 1)) continue;  // seen there
        std::size_t end = l + 1;
        while (end < plan_.layers.size() && side_by_side(a, b, end)) ++end;
        if (end > l + 1) untwist(passing[a], passing[b], l, end);
      }
    }
  }

  /// Tries both orders of two nets in the layers from `begin` to before `end`.
  void untwist(const std::map<std::size_t, std::size_t>& a, const std::map<std::size_t, std::size_t>& b,
               std::size_t begin, std::size_t end) {
    const auto crossings = [&] {
      std::size_t sum = 0;
      for (std::size_t c = begin; c <= end; ++c) sum += count(links_[c]);
      return sum;
    };
    const auto is_above = [&](std::size_t layer) { return position_[a.at(layer)] < position_[b.at(layer)]; };
    std::vector<bool> old;
    for (std::size_t layer = begin; layer < end; ++layer) old.push_back(is_above(layer));
    const auto order = [&](const auto& a_above) {
      for (std::size_t layer = begin; layer < end; ++layer) {
        if (is_above(layer) == a_above(layer)) continue;
        std::swap(position_[a.at(layer)], position_[b.at(layer)]);
        for (const std::size_t slot : {a.at(layer), b.at(layer)})
          plan_.layers[layer][static_cast<std::size_t>(position_[slot])] = slot;
      }
    };
    std::size_t least = crossings();
    std::optional<bool> best;
    for (const bool above : {true, false}) {
      order([&](std::size_t) { return above; });
      const std::size_t here = crossings();
      if (here >= least) continue;
      least = here;
      best = above;
    }
    order([&](std::size_t layer) { return best ? *best : static_cast<bool>(old[layer - begin]); });
  }

  std::size_t count() const {
    std::size_t crossings = 0;
    for (const auto& links : links_) crossings += count(links);
    return crossings;
  }

  std::size_t count(const std::vector<Link>& links) const {
    struct Ends {
      double left, right;
    };
    std::vector<Ends> across;
    std::vector<double> left, right;
    for (const Link& link : links) {
      (link.from.left ? left : right).push_back(place(link.from));
      (link.to.left ? left : right).push_back(place(link.to));
      if (link.from.left == link.to.left) continue;
      const Pin& l = link.from.left ? link.from : link.to;
      const Pin& r = link.from.left ? link.to : link.from;
      across.push_back({place(l), place(r)});
    }
    std::sort(left.begin(), left.end());
    std::sort(right.begin(), right.end());
    std::size_t crossings = 0;
    for (const Link& link : links) {
      if (link.from.left != link.to.left) continue;
      const auto& pins = link.from.left ? left : right;
      const auto [low, high] = std::minmax({place(link.from), place(link.to)});
      crossings += static_cast<std::size_t>(std::lower_bound(pins.begin(), pins.end(), high) -
                                            std::upper_bound(pins.begin(), pins.end(), low));
    }
    std::sort(across.begin(), across.end(), [](const Ends& a, const Ends& b) {
      return a.left != b.left ? a.left < b.left : a.right < b.right;
    });
    std::vector<double> before;  // right ends of those further up on the left, sorted
    for (const Ends& ends : across) {
      const auto at = std::upper_bound(before.begin(), before.end(), ends.right);
      crossings += static_cast<std::size_t>(before.end() - at);
      before.insert(at, ends.right);
    }
    return crossings;
  }

  Plan& plan_;
  std::vector<double> position_;                                           ///< of each slot in its layer
  std::vector<std::vector<Link>> links_;                                   ///< of each channel
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> of_slot_;  ///< channel and index of its links
};

}  // namespace

void reduce_crossings(Plan& plan) {
  Ordering(plan).run();
}

}  // namespace oblique::draw::layered
