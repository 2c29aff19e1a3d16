// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace oblique::network {

/// Which quantities each quantity needs before it can be computed, in compressed rows: those of `i` are
/// `needed[first[i]] … needed[first[i + 1] − 1]`.
struct Dependencies {
  std::vector<std::uint32_t> first{0};
  std::vector<std::uint32_t> needed;

  std::size_t size() const { return first.size() - 1; }
  void add_row(const std::vector<std::uint32_t>& row);
};

/// A step of the order in which quantities are computed: one explicit quantity (no tears), or an algebraic
/// loop whose `tears` are solved for together, with the explicit quantities between them in `inner`, in
/// order.
struct OrderStep {
  std::vector<std::uint32_t> tears;
  std::vector<std::uint32_t> inner;
};

/// Orders quantities so that each comes after what it needs (Tarjan's strongly connected components). Within
/// a cycle, every quantity marked `implicit` is a tear, and explicit ones become tears until no cycle is
/// left: each time the one with the largest product of incoming and outgoing wires.
std::vector<OrderStep> dependency_order(const Dependencies& dependencies, const std::vector<bool>& implicit);

}  // namespace oblique::network
