// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/assembly/assembly.h>

// Events of blocks, and the memories that they set.
namespace oblique::network {

/// Finds the events that can come: the others are left out, and memories that no event sets are constants.
void find_active_events(Assembly& a);

void make_memories(Assembly& a);

/// A memory of a block: its node, or its initial value where nothing ever sets it.
NodeId memory_node(Assembly& a, std::size_t block, std::size_t memory);

void make_events(Assembly& a);

}  // namespace oblique::network
