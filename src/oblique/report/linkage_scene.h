// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/chart/point_plots.h>
#include <oblique/draw/linkage/linkage.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::report {

/// A mechanism's motion as pictures need it: at least two moments, both ends included. Where limits forbid
/// the whole motion, it is the way between them.
struct DrawnMotion {
  std::vector<mechanism::Configuration> rows;
  std::vector<double> times;  ///< [s]
  bool closed = false;        ///< it ends as it begins
  bool ends_at_limit = false;
};
DrawnMotion drawn_motion(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                         int rows);

/// The same as a round to be repeated, in `frames` parts: a closed motion once, another one to its end and
/// back. Positions that cannot be assembled are left out.
DrawnMotion drawn_round(const mechanism::Mechanism& mechanism, int frames);

/// The points with these names; "none" for none, no name for those worth it. Throws ReadError, of the setting
/// 'trace'.
std::vector<std::size_t> traced_points(const mechanism::Mechanism& mechanism,
                                       const std::vector<std::string>& names);

/// A scene and when it happens.
struct TimedScene {
  draw::LinkageScene scene;
  double time = 0;            ///< of the position shown [s]
  std::vector<double> times;  ///< of `scene.motion` [s]
};

/// The mechanism at `time` [s], with `positions` − 1 further positions of its motion.
/// Throws ReadError, and MechanismError (kind `assembly`) where it cannot be assembled there.
TimedScene linkage_scene(const mechanism::Mechanism& mechanism, double time, int positions);

/// A point along the motion for its six plots. Throws ReadError, of the setting
/// 'plots', where there is no such point or no drive.
draw::PointHistory point_history(const mechanism::Mechanism& mechanism, const std::string& point);

}  // namespace oblique::report
