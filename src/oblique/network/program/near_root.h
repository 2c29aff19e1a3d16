// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <oblique/network/program/loop_matrix.h>

namespace oblique::network {

/// The solution of a loop of one unknown nearest to `origin`, by halving intervals at whose ends its residual
/// or its derivative have different signs: where Newton's method goes there and back, beside a place at which
/// the derivative has no bound, as that of √z at zero. Looks no farther than a tenth of 1 + |origin|, and
/// takes no pole or jump for a solution. `evaluate` runs the equations on the slots. True where it found one:
/// the unknown's slot then holds it, and they have been run on it. Not installed.
bool find_near_root(const LoopCode& loop, double* slots, double origin,
                    const std::function<void()>& evaluate);

}  // namespace oblique::network
