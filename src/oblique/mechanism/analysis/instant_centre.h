// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <oblique/mechanism/model/configuration.h>

namespace oblique::mechanism {

/// The point in which two links have the same velocity, by their momentary motion (J. Bernoulli, S.
/// Aronhold, A. Kennedy: those of three links lie on one line).
struct InstantCentre {
  std::optional<std::size_t> first;  ///< index in Mechanism::bodies; none: the frame
  std::size_t second = 0;
  std::optional<Eigen::Vector2d> position;  ///< [length unit]; none where it is at infinity or has no value
  /// Where it is at infinity: the unit vector towards it, square to the relative velocity. None where the
  /// links stand still against each other, or have no velocity.
  std::optional<Eigen::Vector2d> direction;
};

/// The centre of a link against another or the frame. A revolute joint that both share is its place. Angular
/// velocities that differ by less than 1e-12 of the larger one (or of what the velocities over the largest
/// link give) count as equal.
InstantCentre instant_centre(const Mechanism& mechanism, const Configuration& here,
                             std::optional<std::size_t> first, std::size_t second);

/// All n(n − 1)/2 centres of the n links, the frame being one of them: against the frame first.
std::vector<InstantCentre> instant_centres(const Mechanism& mechanism, const Configuration& here);

}  // namespace oblique::mechanism
