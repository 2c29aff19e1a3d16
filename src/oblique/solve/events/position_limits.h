// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

// What counts as a rate where the positions of switches are chosen; not installed.
namespace oblique::solve {

/// How far the states are moved to see what an event function does a moment later [machine unit]: its square
/// is above rounding, its cube below.
inline constexpr double kProbe = 1e-6;

/// A rate below this part of the largest among the trials is none.
inline constexpr double kNoRate = 1e-9;
inline constexpr double kNoLaterRate = 1e-6;
/// Rounding of a rate, of the fastest state's; and of an event function [machine unit].
inline constexpr double kRounding = 1e-13;

/// Whether the rate of an event function, which is `later` after a probe of this length [s], is small beside
/// its change, and turns before it has led out of the rounding of the event function. The quick answer of a
/// fast decay changes a rate as much and more, but only after it has led there.
inline bool is_about_to_turn(double rate, double later, double step) {
  constexpr double kSmall = 0.05, kOfRounding = 10;
  const double change = std::abs(later - rate);
  if ((later > rate) == (rate > 0)) return false;  // it grows
  return std::abs(rate) <= kSmall * change && rate * rate * step <= 2 * kOfRounding * kRounding * change;
}

/// What is no jump of an event function with the position of another unit, where units lie as far as `off`
/// from their switching points: what bends there differs by as much.
inline double no_jump(double off) {
  constexpr double kSteepest = 10;
  return kRounding + kSteepest * off;
}

/// Whether a rate takes an event function out of its rounding at all in a run as long as `span` [s]: where
/// all is at rest there is no faster state beside which to see that it is rounding.
inline bool leaves_rounding(double rate, double span) {
  return std::abs(rate) * span > kRounding;
}

/// The rate of the fastest state, at least `least`.
inline double fastest_of(std::span<const double> derivatives, double least) {
  for (const double derivative : derivatives) least = std::max(least, std::abs(derivative));
  return least;
}

}  // namespace oblique::solve
