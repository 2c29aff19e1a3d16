// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/assembly/assembly.h>

// Events of blocks, and the discrete states that they set.
namespace oblique::network {

/// Finds the events that can come: the others are left out, and discrete states that no event sets are
/// constants.
void find_active_events(Assembly& a);

void make_discrete_states(Assembly& a);

/// A memory of a block: its node, or its initial value where nothing ever sets it.
NodeId discrete_state_node(Assembly& a, std::size_t block, std::size_t discrete_state);

void make_events(Assembly& a);

}  // namespace oblique::network
