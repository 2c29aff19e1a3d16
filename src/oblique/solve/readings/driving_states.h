// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Of each state: whether it is one of `these` or acts on one of them, directly or through other states, by
/// the pattern of the Jacobian.
std::vector<bool> with_driving_states(const network::SparsePattern& jacobian, std::vector<bool> these);

}  // namespace oblique::solve
