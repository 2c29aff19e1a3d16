// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/plan.h>

namespace oblique::draw::layered {

/// Orders the slots of each layer so that few wires cross.
void reduce_crossings(Plan& plan);

}  // namespace oblique::draw::layered
