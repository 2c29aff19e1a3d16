// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace oblique::solve {

/// Tells rounds at one instant that come back to where an earlier one stood, and so go round without end
/// (Brent 1980). It looks from the sixteenth on: by then what turns over again and again has been given its
/// slack. Not installed.
class Circle {
 public:
  /// After a round: whether all is again as it was after an earlier one.
  bool closes(std::span<const double> discrete_states, std::span<const double> x) {
    const auto is_there = [](const std::vector<double>& before, std::span<const double> now) {
      return std::equal(before.begin(), before.end(), now.begin(), now.end());
    };
    if (round_ >= kFirst && is_there(discrete_states_, discrete_states) && is_there(x_, x)) return true;
    if (++round_ < keep_at_) return false;
    keep_at_ *= 2;
    discrete_states_.assign(discrete_states.begin(), discrete_states.end());
    x_.assign(x.begin(), x.end());
    return false;
  }

 private:
  static constexpr int kFirst = 16;

  int round_ = 0, keep_at_ = kFirst;
  std::vector<double> discrete_states_, x_;  ///< that were kept
};

}  // namespace oblique::solve
