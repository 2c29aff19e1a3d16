// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/solve/run.h>

#include "linkage_by_hand.h"

namespace oblique::bench {

/// A shipped mechanism, and the same by hand.
struct LinkageCase {
  std::string file, title;
  HandLinkage by_hand;
  std::vector<std::string> points;  ///< names of those that are shown
  double crank_speed, metres;       ///< [rad/s]; of a machine unit, in the unit of the file
};

LinkageCase four_bar();
LinkageCase six_bar();
LinkageCase jansen();
LinkageCase class_three();

/// The largest error of a run in any column, against a finer one; [the file's unit].
double largest_error(const std::vector<double>& values, const std::vector<double>& finer);

/// t and these points' coordinates, row by row.
std::vector<double> values_of(const solve::Trajectory& ours, const std::vector<std::string>& points);

}  // namespace oblique::bench
