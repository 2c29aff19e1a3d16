// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/patch/circuit.h>

namespace oblique::patch {

/// The triangle of a group of two links (RRR) by a block `dyad-rrr`, and all points that its links carry.
void add_link_dyad(Circuit& circuit, const mechanism::Group& group, const TriangleRange& range);

}  // namespace oblique::patch
