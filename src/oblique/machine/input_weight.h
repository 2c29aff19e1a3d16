// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace oblique::machine {

/// A weight as a machine makes it: setting · gain, at `inputs` inputs in parallel.
struct InputWeight {
  int inputs = 1;
  double gain = 1;
  double setting = 1;  ///< of the potentiometer before them; 1: none
};

/// Splits a weight ≥ 0. `gains` are those of the machine's inputs, ascending; none: any gain can be had, and
/// no potentiometer is needed.
InputWeight split_weight(double weight, std::span<const double> gains);

/// The least time factor of `rates` (ascending) at which one input of the greatest gain (1, where any can be
/// had) is enough for `largest` [1/s]. Where there is none, or no list: `own`, if that is enough, and no more
/// than a hundred times what it would have to be or than 1; or else the least power of ten that is enough,
/// there from 1 on.
double choose_rate(double largest, double own, std::span<const double> rates, std::span<const double> gains);

}  // namespace oblique::machine
