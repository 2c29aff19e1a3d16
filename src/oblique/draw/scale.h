// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/chart.h>

namespace oblique {

/// A mark on an axis.
struct Tick {
  double value = 0;
  std::string label;  ///< empty: a fine line between others
};

/// The range of values that an axis covers.
class Scale {
 public:
  /// Over `values`, those that the axis cannot show left out: decades on a logarithmic axis; on a linear one
  /// with `round` up to round numbers, otherwise exactly. At least something where there is nothing to show.
  Scale(const ChartAxis& axis, const std::vector<double>& values, bool round);

  static bool can_show(const ChartAxis& axis, double value);
  bool shows(double value) const { return can_show(axis_, value); }
  /// 0 at the low end, 1 at the high end.
  double fraction(double value) const;
  double low() const { return low_; }
  double high() const { return high_; }
  /// Adds `part` of the length at both ends.
  void pad(double part);
  /// Makes the length `length` about the same middle, on a linear axis.
  void widen(double length);

  /// About `most` ticks with labels, at round numbers.
  std::vector<Tick> ticks(int most) const;
  /// "error [mm]", "side [10⁻³ m]": the power that the labels leave out.
  std::string title() const;

 private:
  double position(double value) const;
  double step(int most) const;
  int power() const;

  ChartAxis axis_;
  double low_ = 0, high_ = 1;
  double step_ = 0;  ///< to which the range is rounded; 0: it is not
};

/// "10⁻³".
std::string power_of_ten(int exponent);

}  // namespace oblique
