// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::mechanism {

/// A condition too much, and whether it holds without being asked for.
struct Excess {
  std::string pair;                 ///< "the revolute joint of 'EF' at 'E'"
  std::vector<std::size_t> bodies;  ///< of its loop: those that it competes with, in file order
  text::Place place;
  double miss_at_start = 0;  ///< [length unit], of an angle [rad]
  double miss_beside = 0;    ///< 5° of the fastest drive on
  bool is_revolute = false, is_angle = false;
};

/// What the conditions do that are too many in a mechanism, once it is put together without them.
struct Redundancy {
  std::vector<Excess> excesses;
  std::optional<int> mobility;  ///< by rank, of all conditions; where they hold at the start

  /// Whether all conditions hold at the start, and a little on, to 1e-9 of the largest length.
  bool closes_at_start = false, closes_beside = false;
};

/// Puts an over-constrained mechanism together without the conditions that find no unknown to determine
/// (ConstraintGraph) and measures what they miss by. Of a revolute joint with one condition too much the one
/// along the link's bar is left out: the revolute joint becomes a pin in a slot of the bar. Nothing where no
/// condition is too much, drives are, or what is left cannot be put together either.
std::optional<Redundancy> examine_redundancy(const Mechanism& mechanism);

/// What `examine_redundancy` finds, as findings to tell beside those of `find_groups`.
std::vector<text::Diagnostic> redundancy_findings(const Mechanism& mechanism);

}  // namespace oblique::mechanism
