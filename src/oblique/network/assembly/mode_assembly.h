// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include <oblique/network/assembly/assembly.h>

// Modes of operation and the phases of a timeline.
namespace oblique::network {

/// A discrete state for the mode of each group, and one for each of its mode lines.
void make_modes(Assembly& a);

/// The node of a mode of operation; nothing for another name, or where there is no timeline.
std::optional<NodeId> mode_node(const Assembly& a, std::size_t block, std::string_view name);

/// A switch for each mode line.
void define_mode_lines(Assembly& a);

/// A switch for the condition that ends a phase.
void define_phase_ends(Assembly& a);

}  // namespace oblique::network
