// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/picture.h>
#include <oblique/mechanism/configuration.h>

namespace oblique {

/// A point along a motion, and the drive over which it is plotted: one entry a moment.
struct PointHistory {
  std::string title;
  std::string point;               ///< its name
  std::string length_unit;         ///< of the states
  std::string drive;               ///< name
  std::string drive_unit;          ///< "°" or a length unit
  std::vector<double> drives;      ///< [drive_unit]
  std::vector<PointState> states;  ///< what has no value is NaN
};

/// Six plots in one picture: the path, the coordinates, and the components of velocity and acceleration over
/// the drive. The curves have the ids "path", "x", "y", "vx", "vy", "ax", "ay".
Picture draw_point_plots(const PointHistory& history);

}  // namespace oblique
