// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace oblique::solve {

/// Signs for the errors of all states, one after the other, as no order of the states makes them: another
/// combination in each of a few trials, the same in each run. Not installed.
class ErrorSigns {
 public:
  static constexpr std::uint64_t kTrials = 4;

  explicit ErrorSigns(std::uint64_t trial) : bits_(0x9E3779B97F4A7C15 * (trial + 1)) {}

  double next() {
    const double sign = (bits_ >> 63) != 0 ? 1 : -1;
    bits_ = 6364136223846793005 * bits_ + 1442695040888963407;
    return sign;
  }

 private:
  std::uint64_t bits_;
};

}  // namespace oblique::solve
