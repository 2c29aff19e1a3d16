// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/block_library.h>

// Not installed.
namespace oblique::machine {

/// The library with circuits of elements in the place of blocks that no machine has (src/machines/elements):
/// an oscillator of two integrators for a sine source, a comparator and a multiplier for a switch. With ideal
/// elements they do what those blocks do. A block that a user has put in the place of a shipped one stays.
diagram::BlockLibrary element_library(const diagram::BlockLibrary& library);

}  // namespace oblique::machine
