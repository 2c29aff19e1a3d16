// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace oblique::draw {

/// What an axis shows.
struct Axis {
  std::string name;
  std::string unit{};        ///< "mm", "°"; empty: a pure number
  bool logarithmic = false;  ///< values that are not above 0 are left out
};

/// A mark on an axis.
struct Tick {
  double value = 0;
  std::string label;  ///< empty: a fine line between others
};

/// The range of values that an axis covers, and the round numbers in it.
class Scale {
 public:
  /// Over `values`, those that the axis cannot show left out: decades on a logarithmic axis; on a linear one
  /// with `round` up to round numbers, otherwise exactly. At least something where there is nothing to show.
  Scale(const Axis& axis, const std::vector<double>& values, bool round);

  static bool can_show(const Axis& axis, double value);
  bool shows(double value) const { return can_show(axis_, value); }
  /// 0 at the low end, 1 at the high end.
  double fraction(double value) const;
  double low() const { return low_; }
  double high() const { return high_; }
  bool is_logarithmic() const { return axis_.logarithmic; }
  /// Adds `part` of the length at both ends.
  void pad(double part);
  /// Makes the length `length` about the same middle, on a linear axis.
  void widen(double length);
  /// Leaves out the same power of ten as an axis on which `other` is the farthest from 0.
  void count_like(const Scale& other);

  /// Ticks at round numbers that are at least `1/most` of the length apart; a little nearer at the ends of a
  /// rounded range.
  std::vector<Tick> ticks(double most) const;
  /// "error [mm]", "side [10⁻³ m]": the power that the labels leave out.
  std::string title() const;

 private:
  double position(double value) const;
  double step(double most) const;
  double size() const;
  int power() const;

  Axis axis_;
  double low_ = 0, high_ = 1;
  double step_ = 0;           ///< to which the range is rounded; 0: it is not
  double size_of_other_ = 0;  ///< of the axis that this one counts like
};

/// "10⁻³".
std::string power_of_ten(int exponent);

}  // namespace oblique::draw
