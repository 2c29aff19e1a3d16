// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace oblique::solve {

/// A switch that turned over, with an effect, where the errors of the states do not tell its event function
/// from zero, or that did not, where it came so near: whether it turns over at all, rounding has decided.
struct FaintTurn {
  std::uint32_t number = 0;  ///< in Program::switches
  double time = 0;           ///< [s]
  double error = 0;          ///< of its event function
  bool turned = true;
  std::vector<std::size_t> states;  ///< that decide about it, and would be known better by a finer run
};

}  // namespace oblique::solve
