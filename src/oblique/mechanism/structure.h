// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <oblique/mechanism/mechanism.h>

namespace oblique {

/// A body turned by a drive about a point that is known already (class I).
struct CrankGroup {
  std::string name;       ///< of the body
  std::size_t body = 0;   ///< index in Mechanism::bodies
  std::size_t pivot = 0;  ///< index in Mechanism::points
  std::size_t drive = 0;  ///< index in Mechanism::drives
};

/// Two bodies on two known points, hinged to each other: the RRR Assur group of class II.
///
///            C             C lies left of P → Q: side = +1
///      r₁  /   \  r₂
///     P ---- L ---- Q
struct DyadGroup {
  std::string name;       ///< "BC-CD": of its bodies
  std::size_t body1 = 0;  ///< index in Mechanism::bodies; stands before body2 in the file
  std::size_t p = 0;      ///< known point of body1, index in Mechanism::points
  std::size_t body2 = 0;
  std::size_t q = 0;  ///< known point of body2
  std::size_t c = 0;  ///< the common hinge
  double r1 = 0;      ///< |PC| [length unit]
  double r2 = 0;      ///< |QC| [length unit]
  int side = 0;       ///< +1: C left of P → Q, −1: right; 0 only before `choose_modes`
};

using Group = std::variant<CrankGroup, DyadGroup>;

/// The groups of a mechanism in an order in which each needs only the ones before it.
struct Structure {
  std::vector<Group> groups;
};

/// Name of a group, of whatever kind.
const std::string& group_name(const Group& group);

/// The bodies of a group, in file order (indices in Mechanism::bodies).
std::vector<std::size_t> group_bodies(const Group& group);

/// Degrees of freedom by Chebyshev's formula W = 3n − 2p: n moving bodies, p hinges; a point that k bodies
/// share (the frame is one of them) counts as k − 1 hinges.
int mobility(const Mechanism& mechanism);

/// Takes a mechanism apart into cranks and dyads, in file order wherever there is a choice. No assembly modes
/// are chosen (side = 0). Throws MechanismError: kind `mobility` where mobility and drives do not match, in
/// the whole or in a part; kind `group_class` where a group of class III or higher remains.
Structure find_groups(const Mechanism& mechanism);

/// `find_groups`, and the assembly mode of each dyad as the sketch picks it at the start position
/// (`choose_modes`). Throws MechanismError: as both.
Structure decompose(const Mechanism& mechanism);

}  // namespace oblique
