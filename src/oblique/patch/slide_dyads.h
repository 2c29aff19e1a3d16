// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/patch/circuit.h>

namespace oblique::patch {

/// Whether there is a block for a group of one unknown point or link.
bool has_slide_dyad(const mechanism::Group& group);

/// Places the unknown point or link of a group and all that it carries: RRP, RPR, PRP, RPP, and drives along
/// slides.
void add_slide_dyad(Circuit& circuit, const mechanism::Group& group);

}  // namespace oblique::patch
