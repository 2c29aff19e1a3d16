// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/configuration.h>
#include <oblique/mechanism/structure.h>

namespace oblique {

/// One way to put a group together.
struct AssemblyMode {
  int side = 0;                            ///< as in DyadGroup
  bool selected = false;                   ///< it is the one of the structure
  std::vector<std::size_t> points;         ///< the points the group places, indices in Mechanism::points
  std::vector<Eigen::Vector2d> positions;  ///< of `points` [length unit]
};

/// The assembly modes of one group, the groups before it standing as the structure says. Empty: it cannot be
/// assembled.
struct GroupModes {
  std::size_t group = 0;  ///< index in Structure::groups
  std::vector<AssemblyMode> modes;
};

/// Sets the side of each dyad: of the two ways to assemble it at the start position, the one nearer to the
/// sketched points of its bodies (root sum of squared distances). Throws MechanismError: kind `assembly`
/// where links do not reach, kind `sketch` where no sketched point tells the two modes apart; the message
/// lists both as lines to paste.
void choose_modes(const Mechanism& mechanism, Structure& structure);

/// Every assembly mode of every group at the given drive angles [rad]. Groups that hang on one that cannot be
/// assembled have no modes. Cranks have one mode, dyads two (one where the triangle is flat).
std::vector<GroupModes> assembly_modes(const Mechanism& mechanism, const Structure& structure,
                                       std::span<const double> drive_angles);

}  // namespace oblique
