// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include <oblique/text/diagnostic.h>

namespace oblique::diagram {

struct BlockDefinition;

/// What a real machine makes of a block: the `role` of its file. A block with a role is, as long as its other
/// parameters have their defaults, what is said here of its first input, and a machine may build it
/// otherwise.
enum class Role {
  other,           ///< an element of its own, which a machine may not have
  reference,       ///< `value`: a voltage that the machine has for nothing
  potentiometer,   ///< `setting` · in
  gain,            ///< `factor` · in: a potentiometer, the gain of an input, or both
  inverter,        ///< −in, on every machine
  summer,          ///< Σ in, and −Σ in where the machine inverts
  integrator,      ///< d out/dt = `rate` Σ in from `initial`, inverting likewise
  open_amplifier,  ///< −`gain` Σ in, without feedback of its own: its inversion is part of its equation
  multiplier,      ///< x · y
  squarer,         ///< in · in: a multiplier with one signal at both inputs
  comparator,      ///< counted as one
  function_generator,  ///< counted as one
};

/// "open-amplifier": as a file writes it. "" for `other`, which no file writes.
std::string_view role_name(Role role);

/// Reads the `role` of a block file, or reports that there is none of that name.
Role read_role(std::string_view name, const text::Place& place, text::Diagnostics& diagnostics);

/// Reports where a block does not have the inputs and parameters of its role, or where its equations with the
/// defaults of its parameters say something else. `place` is that of the role.
void check_role(const BlockDefinition& block, const text::Place& place, text::Diagnostics& diagnostics);

}  // namespace oblique::diagram
