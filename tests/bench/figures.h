// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace oblique::bench {

/// CPU time of this thread [s]: on a shared machine the wall clock measures the neighbours.
double cpu_seconds();

/// The middle value; the mean of the two middle ones where their number is even. NaN of nothing.
double median(std::vector<double> values);

/// A measured number that must not exceed a bound.
struct Figure {
  std::string name;
  double value = 0;
  double bound = 0;
  std::string unit;  ///< "" for a ratio
};

/// Keeps a figure for `print_figures`; of one that is measured again the last value counts.
void record(Figure figure);

/// Prints all figures with their bounds, and whether they are met.
void print_figures();

}  // namespace oblique::bench
