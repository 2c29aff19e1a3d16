// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>

#include <oblique/diagram/flat_diagram.h>

namespace oblique::machine {

/// What a block is on a machine.
enum class Role {
  reference,       ///< a voltage that the machine has for nothing
  coefficient,     ///< a factor alone: a potentiometer, or the gain of an input
  inverter,        ///< inverts on every machine
  summer,          ///< inverts where the machine does
  integrator,      ///< likewise
  open_amplifier,  ///< without feedback of its own; its inversion is part of its equation
  multiplier,
  other,  ///< comparators, function generators, and what no machine has
};

/// What blocks of a definition are. One of a user's own under a shipped name is `other` where it has not the
/// parameters of the role.
Role role_of(const diagram::BlockDefinition& definition);

/// What the shipped blocks of the name are.
Role role_of(std::string_view block);

/// Whether the block's parameters, but those of the names given, have their defaults: whether it is free of
/// imperfections of its own.
bool has_defaults(const diagram::FlatBlock& block, std::initializer_list<std::string_view> but = {});

/// The value of a parameter of the block; the definition must have it.
double parameter_of(const diagram::FlatBlock& block, std::string_view name);

/// Numbers elements as a patch panel does: A1, A2 … amplifiers, P1 … potentiometers, M1 … multipliers, K1 …
/// comparators, F1 … function generators, X1 … others; nothing for a reference.
class ElementNumbers {
 public:
  /// That of the next block of this name.
  std::string next(std::string_view block);

 private:
  std::map<char, int> last_;
};

}  // namespace oblique::machine
