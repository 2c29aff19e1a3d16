// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/slot_links.h>

namespace oblique::draw::layered {
namespace {

void add_link(const Plan& plan, const Branch& branch, const Pin& a, const Pin& b,
              std::vector<std::vector<SlotLink>>& links) {
  if (a.slot == b.slot) return;
  const bool a_passes = plan.slots[a.slot].passes(), b_passes = plan.slots[b.slot].passes();
  // A long wire is to be straight above all, then a way that no other wire shares.
  double weight = a_passes && b_passes ? 8 : a_passes || b_passes ? 2 : 3;
  weight *= branch.weight;
  const bool same_side = a.left == b.left;
  if (same_side) {
    weight = 0.25;  // near, but it has to turn anyway
  } else if (branch.pins.size() == 2) {
    weight *= 1.5;
  }
  links[a.slot].push_back({b.slot, b.offset - a.offset, weight, !same_side && b.left, same_side});
  links[b.slot].push_back({a.slot, a.offset - b.offset, weight, !same_side && a.left, same_side});
}

}  // namespace

std::vector<std::vector<SlotLink>> links_of(const Plan& plan) {
  std::vector<std::vector<SlotLink>> links(plan.slots.size());
  for (const auto& channel : plan.channels) {
    for (const Branch& branch : channel) {
      for (std::size_t k = 1; k < branch.pins.size(); ++k)
        add_link(plan, branch, branch.pins[0], branch.pins[k], links);
    }
  }
  return links;
}

double distance(const Plan& plan, std::size_t upper, std::size_t lower) {
  constexpr double kBoxGap = 2 * kLayoutGrid;  // between boxes, and between a box and a wire
  const Slot& above = plan.slots[upper];
  return above.height + (above.passes() && plan.slots[lower].passes() ? kLayoutGrid : kBoxGap);
}

}  // namespace oblique::draw::layered
