// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include <oblique/mechanism/configuration.h>

namespace oblique {

/// What keeps a mechanism from turning: a moment at which a dyad is flat or does not reach.
struct Obstacle {
  double time = 0;        ///< [s]
  std::size_t group = 0;  ///< index in Structure::groups
  Status status = Status::open;
};

/// The first obstacle found within one turn of the first drive, or none. It is looked for at positions half a
/// degree of the fastest drive apart and, wherever a dyad's distance |PQ| could come to the limits of its
/// links between two of them at four times the rates that it has there, at positions ever closer, down to
/// the rounding of the lengths; so a dead centre that is only touched, or an opening of a millionth of a
/// turn, is found as well. Throws MechanismError (kind `request`) as `period` and `check_travel`.
std::optional<Obstacle> find_obstacle(const Mechanism& mechanism, const Structure& structure);

}  // namespace oblique
