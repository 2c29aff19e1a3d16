// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/solver/group_equations.h>

namespace oblique::mechanism {

/// The point (index in Mechanism::points) in the place where a group has all its joints with the rest;
/// nothing where there are two places, a line or a direction that are given. About that point every pose of
/// the group may be turned, so none is definite, whatever the number of its conditions.
std::optional<std::size_t> free_to_turn_about(const GroupEquations& equations, const Configuration& here);

}  // namespace oblique::mechanism
