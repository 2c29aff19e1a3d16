// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program.h>

namespace oblique {

/// Of each state: whether it is one of `these` or acts on one of them, directly or through other states, by
/// the pattern of the Jacobian.
std::vector<bool> with_driving_states(const SparsePattern& jacobian, std::vector<bool> these);

}  // namespace oblique
