// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// One way to put a group together.
struct AssemblyMode {
  GroupPose pose;                          ///< with its side, as in Group
  bool selected = false;                   ///< it is the one of the structure
  std::vector<std::size_t> points;         ///< the points the group places, indices in Mechanism::points
  std::vector<Eigen::Vector2d> positions;  ///< of `points` [length unit]
};

/// The assembly modes of one group, the groups before it standing as the structure says. Empty: it cannot be
/// assembled.
struct GroupModes {
  std::size_t group = 0;  ///< index in Structure::groups
  bool complete = true;   ///< false: found by a search, so there are at least these
  std::vector<AssemblyMode> modes;
};

/// Sets the side and the start of each group: of the ways to assemble it at the start position, the one
/// nearest to the sketched points of its links (root sum of squared distances). Throws MechanismError: kind
/// `assembly` where links do not reach, kind `sketch` where no sketched point tells the modes apart (the
/// message lists them as lines to paste), kind `constraint` where conditions depend on each other.
void choose_modes(const Mechanism& mechanism, Structure& structure);

/// As `choose_modes`, but a group that the sketch does not decide takes its first mode; gives these groups,
/// indices in Structure::groups.
std::vector<std::size_t> choose_some_modes(const Mechanism& mechanism, Structure& structure);

/// Every assembly mode of every group, the groups before it as in `here`, a configuration of the structure at
/// these states of the drives (of a Follower, or `start_configuration`). Groups that hang on one that cannot
/// be assembled have no modes.
std::vector<GroupModes> assembly_modes(const Mechanism& mechanism, const Structure& structure,
                                       std::span<const DriveState> drives, const Configuration& here);

}  // namespace oblique::mechanism
