// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/machine/circuit.h>

namespace oblique::machine {

/// Whether a comparator without memory, which compares weight · source + offset, gives what the comparator
/// `source` gives: both have the same two levels, and between those of the source lies what it switches at.
bool only_repeats(const diagram::FlatBlock& comparator, double weight, double offset,
                  const diagram::FlatBlock& source);

}  // namespace oblique::machine
