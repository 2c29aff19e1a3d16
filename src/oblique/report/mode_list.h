// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/solver/assembly.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::report {

/// A mechanism at one position of its drives, with what can be put together there.
struct ModesAt {
  std::vector<mechanism::DriveState> drives;
  bool open = false;
  std::vector<std::size_t> undecided;  ///< groups for which the sketch picks no mode
  std::vector<mechanism::GroupModes> groups;
};

/// At a moment [s]; chooses the modes of the structure as its sketch does.
ModesAt modes_at(const mechanism::Mechanism& mechanism, mechanism::Structure& structure, double time);

/// The modes of each group, with the coordinates of its points.
std::string to_text(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                    const ModesAt& position);
std::string to_json(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                    const ModesAt& position);

}  // namespace oblique::report
