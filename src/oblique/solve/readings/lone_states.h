// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Of each unit of switches the state that its event function reads, where that is the only one, and it reads
/// no memory, no position of a switch and no unknown of an algebraic loop besides: the velocity of dry
/// friction. (It may read the time.) Not installed.
std::vector<std::optional<std::size_t>> lone_states(const network::Program& program);

}  // namespace oblique::solve
