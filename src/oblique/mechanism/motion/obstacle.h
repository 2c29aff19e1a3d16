// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// What keeps a mechanism from turning: a moment beyond which a group cannot be assembled (`open`), or at
/// which its modes meet (`dead_centre`).
struct Obstacle {
  double time = 0;        ///< [s]
  std::size_t group = 0;  ///< index in Structure::groups
  Status status = Status::open;
  bool infinite = false;  ///< `open`, since the group goes away without end
};

/// The first obstacle within one turn of the first drive, or none; found by a Follower. Throws MechanismError
/// (kind `request`) as `period` and `check_travel`.
std::optional<Obstacle> find_obstacle(const Mechanism& mechanism, const Structure& structure);

}  // namespace oblique::mechanism
