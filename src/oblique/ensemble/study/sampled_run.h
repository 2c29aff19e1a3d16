// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <oblique/ensemble/study/row_expression.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// The rows of a run, evenly spaced in time, and what is between them.
///
/// Between rows a column is the polynomial of fifth degree through six of them where it is smooth there:
/// where the fourth differences are less than a quarter of the second ones, so that a sine of thirteen rows a
/// period is. Elsewhere (at a kink, a jump, or where the rows are too few) it is the straight line, which
/// overshoots nothing. Expressions are evaluated of the columns there; integrals are by Gauss's rule of three
/// points between each two rows.
class SampledRun {
 public:
  /// Columns of one length, of two rows at the least; the first one is the time.
  explicit SampledRun(std::vector<std::vector<double>> columns) : columns_(std::move(columns)) {}

  std::size_t rows() const { return columns_.front().size(); }
  std::size_t columns() const { return columns_.size(); }
  std::span<const double> column(std::size_t c) const { return columns_[c]; }

  /// The values of an expression at the rows.
  std::vector<double> values(const RowExpression& expression) const;

  /// The greatest value, between the rows too; "not a number" where one of the rows is none.
  double maximum(const RowExpression& expression) const;
  double minimum(const RowExpression& expression) const;
  double integral(const RowExpression& expression) const { return integral(expression, false); }
  double integral_of_square(const RowExpression& expression) const { return integral(expression, true); }
  double duration() const { return columns_[0].back() - columns_[0].front(); }

  /// The first time at which a condition holds, "not a number" where it never does. `sides` are the
  /// differences that change their signs where it may come to hold.
  double first_time(const RowExpression& condition, std::span<const RowExpression> sides) const;

  /// By what part of the largest value the rows may be too few for the extremes and integrals that were asked
  /// for, as far as rows tell: where the straight line is taken, what it misses of a parabola through three
  /// of them.
  double doubt() const { return doubt_; }

 private:
  double extreme(const RowExpression& expression, double sign) const;
  double integral(const RowExpression& expression, bool squared) const;
  double value_at(const RowExpression& expression, std::size_t interval, double place) const;

  void doubt_extreme(std::span<const double> f, double sign) const;
  void doubt_integral(std::span<const double> f) const;

  std::vector<std::vector<double>> columns_;
  mutable double doubt_ = 0;
};

}  // namespace oblique::ensemble
