// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <oblique/mechanism/motion/scan.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// How well a group passes on force and motion over a motion range.
struct Transmission {
  enum class Measure {
    transmission_angle,  ///< of an RRR dyad: between its two bars [rad], best at 90°
    pressure_angle,      ///< of an RRP dyad: between its bar and the guide [rad], best at 0
    determinant,  ///< of any other group: |GroupSolver::normalised_determinant|, 1 at best, 0 at a dead
                  ///< centre
  };
  std::size_t group = 0;  ///< index in Structure::groups
  Measure measure = Measure::determinant;
  Reading least, greatest;

  /// Whether an angle leaves what textbooks allow at the most: 30° to 150°, of a pressure angle 60°, so that
  /// the bar stays 30° away from the guide's normal. Never of a determinant.
  bool is_poor() const;
};

/// "transmission angle", "pressure angle", "determinant".
std::string_view measure_name(Transmission::Measure measure);

/// What measures a group, nothing for drives.
std::optional<Transmission::Measure> measure_of(const Group& group);

/// The measure of a group as a signal; the group must have one.
Signal transmission_signal(const Structure& structure, std::size_t group);

/// Its value in a configuration where that needs no more than positions: of the two angles; nothing for
/// others.
std::optional<double> transmission_in(const Group& group, const Configuration& here);

}  // namespace oblique::mechanism
