// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include <oblique/text/quantity.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// The values of a varied name, as they are written: a list "1,2,5" of values and of ranges "0.8..1.2:9",
/// "1e2..1e6:5:log". Without its number of values a range is what points between its bounds are chosen from.
class Levels {
 public:
  /// Numbers without a unit are in `unit`. Throws ExpressionError.
  Levels(std::string_view text, const text::Unit& unit);

  /// The values of a grid, in the order in which they are written; of a range without a number of them none.
  const std::vector<double>& grid() const { return grid_; }
  /// Whether it is one range, with a number of values or without one.
  bool is_range() const { return is_range_; }
  bool logarithmic() const { return logarithmic_; }  ///< the range is
  double lowest() const;
  double highest() const;

  /// The value at a place from 0 to 1: between the bounds of the range, or the one of the list.
  double at(double place) const;

 private:
  std::vector<double> grid_;
  bool is_range_ = false, logarithmic_ = false;
  double from_ = 0, to_ = 0;  ///< of the range
};

}  // namespace oblique::ensemble
