// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/block_library.h>

namespace oblique::fuzz {

/// The shipped blocks, and a few of our own for what none of those does: events that set states, that pile
/// up, that exchange memories.
const diagram::BlockLibrary& library();

}  // namespace oblique::fuzz
