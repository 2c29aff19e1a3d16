// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>

#include <oblique/text/operations.h>

namespace oblique::text {

/// All numbers from `low` to `high`.
struct Interval {
  double low = 0, high = 0;

  double width() const { return high - low; }
  bool is_point() const { return low == high; }
  bool contains(double value) const { return low <= value && value <= high; }
};

/// The least interval with all of these; the whole line where one is no number.
Interval hull(std::initializer_list<double> values);

/// What holds every value that a smooth operation has for operands from these intervals (Moore 1966, to
/// rounding); the whole line where it is not known. Of `noise`, whose knots are one apart, arguments less
/// than a quarter wide are sampled. Of one operand, `b` is not looked at.
Interval evaluate(Operation operation, const Interval& a, const Interval& b = {});

/// The same of a number times itself.
Interval square(const Interval& x);

}  // namespace oblique::text
