// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <oblique/text/expression.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// An expression of the columns of a table, made ready to be evaluated at many rows.
class RowExpression {
 public:
  /// The number of the column that a name means; throws where it means none.
  using ColumnOf = std::function<std::size_t(const text::Expression& name)>;

  RowExpression() = default;
  RowExpression(const text::Expression& expression, const ColumnOf& column_of);

  /// The columns that it takes, each once.
  const std::vector<std::size_t>& columns() const { return columns_; }

  /// `columns[c]` are the values of column c at all of the rows; those that it does not take may be null.
  void evaluate(std::span<const double* const> columns, std::span<double> values) const;
  /// At a single row.
  double evaluate(std::span<const double> row) const;

 private:
  struct Instruction {
    text::Expression::Kind kind{};
    text::Function function{};
    std::size_t count = 0;  ///< of operands; the column of a name
    double number = 0;
  };

  void add(const text::Expression& expression, const ColumnOf& column_of);
  void evaluate_block(std::span<const double* const> columns, std::size_t first,
                      std::span<double> values) const;

  std::vector<Instruction> instructions_;  ///< the operands before the operator
  std::vector<std::size_t> columns_;
  std::size_t deepest_ = 0, depth_ = 0;
};

}  // namespace oblique::ensemble
