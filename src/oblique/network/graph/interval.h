// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/tape.h>

namespace oblique::network {

/// All numbers from `low` to `high`.
struct Interval {
  double low = 0, high = 0;

  double width() const { return high - low; }
  bool contains(double value) const { return low <= value && value <= high; }
};

/// Runs instructions on intervals: each result holds every value that the instruction has for operands from
/// its intervals (Moore 1966, to rounding), and is the whole line where it is not known. Of `noise`, whose
/// knots are one apart, arguments less than a quarter wide are sampled.
void run_tape(std::span<const Instruction> instructions, std::span<Interval> slots);

}  // namespace oblique::network
