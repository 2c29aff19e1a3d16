// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/chart/chart.h>
#include <oblique/mechanism/model/configuration.h>

namespace oblique::draw {

/// A point along a motion, and the drive over which it is plotted: one entry a moment.
struct PointHistory {
  std::string title;
  std::string point;                          ///< its name
  std::string length_unit;                    ///< of the states
  std::string drive;                          ///< name
  std::string drive_unit;                     ///< "°" or a length unit
  std::vector<double> drives;                 ///< [drive_unit]
  std::vector<mechanism::PointState> states;  ///< what has no value is NaN
  bool ends_at_limit = false;                 ///< velocities grow beyond all bounds there
  double size = 0;  ///< of the mechanism [length unit]; beside it and `rate` rounding is seen
  double rate = 0;  ///< how fast it moves [1/s]
};

/// Six plots in one chart, in three columns: the path and the coordinates, the components of the velocity,
/// those of the acceleration; all but the path over the drive. What rounding leaves of a component is drawn
/// as 0, and of velocities and accelerations what rises out of sight at a limit is left out.
Chart point_plots(const PointHistory& history);

}  // namespace oblique::draw
