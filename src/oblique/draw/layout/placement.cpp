// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/placement.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/draw/layout/slot_links.h>
#include <oblique/draw/layout/straighten.h>

// How slots come to their heights. Their order in each layer is settled; now wires are to run straight. In
// one layer, with the others held, that is a problem with an exact solution: each slot has wishes (the
// heights at which its wires would be straight, weighted), and the heights must rise by at least the
// distances between neighbours. With these distances subtracted it is a monotone regression, which pooling
// of adjacent violators solves in one pass. So the layers are solved one by one, in sweeps to the right and
// to the left:
//
// 1. Six sweeps with means, and wishes only towards the side that the sweep comes from: that settles
//    quickly.
// 2. Six with means towards both sides. Then everything is put on the grid.
// 3. Twenty-four with medians: a median takes the height of one wire, which is then quite straight, where a
//    mean leaves all of them a little bent; and it stays on the grid.
// 4. `straighten`, for what the sweeps cannot do one layer at a time.

namespace oblique::draw::layered {
namespace {

constexpr int kMeanSweeps = 12;
constexpr int kMedianSweeps = 24;

/// Where something should be, and how much it matters.
struct Wish {
  double y;
  double weight;
};

double mean(const std::vector<Wish>& wishes) {
  double sum = 0, weights = 0;
  for (const Wish& wish : wishes) {
    sum += wish.weight * wish.y;
    weights += wish.weight;
  }
  return sum / weights;
}

double median(std::vector<Wish> wishes) {
  std::sort(wishes.begin(), wishes.end(), [](const Wish& a, const Wish& b) { return a.y < b.y; });
  double half = 0;
  for (const Wish& wish : wishes) half += wish.weight / 2;
  for (const Wish& wish : wishes) {
    half -= wish.weight;
    if (half <= 0) return wish.y;
  }
  return wishes.back().y;
}

/// The rising sequence nearest to the wishes, by pooling adjacent violators (R. Barlow and others,
/// "Statistical inference under order restrictions", 1972): nearest in the mean square with `mean`, in the
/// sum of distances with `median`.
template <class Centre>
std::vector<double> rising(std::vector<std::vector<Wish>> wishes, const Centre& centre) {
  struct Pool {
    double y;
    std::size_t members;
    std::vector<Wish> wishes;
  };
  std::vector<Pool> pools;
  for (auto& own : wishes) {
    const double y = centre(own);
    pools.push_back({y, 1, std::move(own)});
    while (pools.size() > 1 && pools[pools.size() - 2].y > pools.back().y) {
      Pool last = std::move(pools.back());
      pools.pop_back();
      Pool& pool = pools.back();
      pool.wishes.insert(pool.wishes.end(), last.wishes.begin(), last.wishes.end());
      pool.members += last.members;
      pool.y = centre(pool.wishes);
    }
  }
  std::vector<double> result;
  for (const Pool& pool : pools) result.insert(result.end(), pool.members, pool.y);
  return result;
}

class Placement {
 public:
  explicit Placement(Plan& plan) : plan_(plan), links_(links_of(plan)) {}

  void run() {
    for (const auto& layer : plan_.layers) {
      double y = 0;
      for (std::size_t k = 0; k < layer.size(); ++k) {
        if (k > 0) y += distance(plan_, layer[k - 1], layer[k]);
        plan_.slots[layer[k]].y = y;
      }
    }
    for (int sweep = 0; sweep < kMeanSweeps; ++sweep)
      sweep_layers(sweep % 2 == 0, sweep < kMeanSweeps / 2, &mean);
    for (Slot& slot : plan_.slots) slot.y = std::round(slot.y / kLayoutGrid) * kLayoutGrid;
    for (int sweep = 0; sweep < kMedianSweeps; ++sweep) sweep_layers(sweep % 2 == 0, false, &median);
    straighten(plan_);
    double least = std::numeric_limits<double>::max();
    for (const Slot& slot : plan_.slots) least = std::min(least, slot.y);
    for (Slot& slot : plan_.slots) slot.y -= least;
  }

 private:
  /// Moves the slots of every layer to where their wires are shortest; with `one_side` only those to the
  /// layer that the sweep comes from.
  template <class Centre>
  void sweep_layers(bool to_the_right, bool one_side, const Centre& centre) {
    const std::size_t n = plan_.layers.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto& layer = plan_.layers[to_the_right ? i : n - 1 - i];
      std::vector<double> stacked;  // where the slots are when they stand as close as they may
      std::vector<std::vector<Wish>> wishes;
      for (std::size_t k = 0; k < layer.size(); ++k) {
        stacked.push_back(k == 0 ? 0 : stacked.back() + distance(plan_, layer[k - 1], layer[k]));
        std::vector<Wish> own;
        for (const SlotLink& link : links_[layer[k]]) {
          if (one_side && link.before != to_the_right) continue;
          own.push_back({plan_.slots[link.other].y + link.shift - stacked.back(), link.weight});
        }
        if (own.empty()) own.push_back({plan_.slots[layer[k]].y - stacked.back(), 0.01});
        wishes.push_back(std::move(own));
      }
      const std::vector<double> places = rising(std::move(wishes), centre);
      for (std::size_t k = 0; k < layer.size(); ++k) plan_.slots[layer[k]].y = places[k] + stacked[k];
    }
  }

  Plan& plan_;
  std::vector<std::vector<SlotLink>> links_;  ///< of each slot
};

}  // namespace

void place_slots(Plan& plan) {
  Placement(plan).run();
}

}  // namespace oblique::draw::layered
