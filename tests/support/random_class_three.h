// SPDX-License-Identifier: MIT
// Random class III mechanisms and whether their patches track them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <oblique/diagram/block_library.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch.h>

namespace oblique::testing {

/// A crank and a triad on three links with anchors and joints anywhere in a square of 3 m, that turn fully
/// and whose determinant (GroupSolver) never falls below 0.1, a tenth of the greatest there is:
/// well-conditioned everywhere. The same seed gives the same mechanism on every machine.
mechanism::Mechanism random_class_three(std::uint64_t seed);

/// How a patch of gain 1e4 follows its mechanism over a turn.
struct Tracking {
  bool tracks = false;      ///< stable everywhere, and within 10/gain of the largest link
  double error = 0;         ///< largest distance of a point from its exact place over the largest link
  std::string split;        ///< that was taken, with how much slower its loop is
  std::string explanation;  ///< where it does not track
};
Tracking track(const mechanism::Mechanism& mechanism, patch::PatchMethod method,
               const diagram::BlockLibrary& library);

}  // namespace oblique::testing
