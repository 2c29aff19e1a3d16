// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/mechanism/solver/group_equations.h>

namespace oblique::mechanism {

/// The order of a group: its pairs with what is placed before. `known` says of each point whether it is.
int order_of(const Mechanism& mechanism, const GroupMembers& members, const std::vector<bool>& known);

/// Its class after Assur and Artobolevsky. Links and pairs make a graph: its largest closed contour is a
/// link with that many pairs, or the longest of the shortest loops through a pair.
int class_of(const Mechanism& mechanism, const GroupMembers& members, const std::vector<bool>& known);

}  // namespace oblique::mechanism
