// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include <oblique/mechanism/solver/group_equations.h>

namespace oblique::mechanism {

inline bool has(const std::vector<std::size_t>& list, std::size_t item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

/// The order of a group: its pairs with what is placed before. `known` says of each point whether it is.
int order_of(const Mechanism& mechanism, const GroupMembers& members, const std::vector<bool>& known);

/// Its class after Assur and Artobolevsky. Links and pairs make a graph: its largest closed contour is a
/// link with that many pairs, or the longest of the shortest loops through a pair.
int class_of(const Mechanism& mechanism, const GroupMembers& members, const std::vector<bool>& known);

}  // namespace oblique::mechanism
