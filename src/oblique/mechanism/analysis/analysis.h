// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/mechanism/analysis/instant_centre.h>
#include <oblique/mechanism/analysis/transmission.h>
#include <oblique/mechanism/motion/motion_range.h>
#include <oblique/mechanism/motion/path_measure.h>
#include <oblique/mechanism/motion/sweep.h>
#include <oblique/mechanism/structure/loops.h>
#include <oblique/mechanism/structure/rank.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// The path of a point with its bounding box and dwells.
struct PathReport {
  PathMeasure measure;
  Reading left, right, bottom, top;  ///< least and greatest x and y [length unit]
  std::vector<Dwell> dwells;
};

/// Where there are masses.
struct InertiaReport {
  struct Bar {
    std::size_t body = 0;
    double mass = 0, inertia = 0;  ///< [kg], [kg m²] about its middle
  };
  std::vector<Bar> bars;
  Reading least, greatest;                ///< reduced to the first drive [kg m²] or [kg]
  Reading least_energy, greatest_energy;  ///< kinetic [J]
};

/// What a mechanism does over its motion range (plan_motion_range): what can be said without moving is there
/// for structures too.
struct MechanismAnalysis {
  MobilityReport mobility;
  std::vector<FourBarLoop> four_bars;
  std::vector<SliderLoop> sliders;
  std::optional<MotionRange> motion_range;  ///< none: it has no drive
  std::vector<Transmission> transmissions;  ///< of all groups that have a measure
  std::vector<Sweep> swings;                ///< of all links and prismatic joints that no drive moves itself
  std::vector<PathReport> paths;            ///< of all moving points
  std::vector<InstantCentre> centres;       ///< at the start; against the frame first
  std::optional<InertiaReport> inertia;
};

/// Everything above. Throws as `plan_motion_range`.
MechanismAnalysis analyse(const Mechanism& mechanism, const Structure& structure);

}  // namespace oblique::mechanism
