// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/row_expression.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <oblique/text/operations.h>

namespace oblique::ensemble {
namespace {

using Node = text::Expression::Kind;

constexpr std::size_t kBlock = 64;  ///< rows that are evaluated together

double combine(Node kind, double a, double b) {
  switch (kind) {
    case Node::negate:
      return -a;
    case Node::add:
      return a + b;
    case Node::subtract:
      return a - b;
    case Node::multiply:
      return a * b;
    case Node::divide:
      return a / b;
    case Node::power:
      return text::evaluate(text::Operation::power, a, b);
    case Node::less:
      return a < b ? 1 : 0;
    case Node::less_equal:
      return a <= b ? 1 : 0;
    case Node::greater:
      return a > b ? 1 : 0;
    case Node::greater_equal:
      return a >= b ? 1 : 0;
    case Node::equal:
      return a == b ? 1 : 0;
    case Node::not_equal:
      return a != b ? 1 : 0;
    case Node::logical_and:
      return a != 0 && b != 0 ? 1 : 0;
    case Node::logical_or:
      return a != 0 || b != 0 ? 1 : 0;
    case Node::logical_not:
      return a == 0 ? 1 : 0;
    case Node::number:
    case Node::name:
    case Node::call:
      break;
  }
  return std::nan("");
}

}  // namespace

RowExpression::RowExpression(const text::Expression& expression, const ColumnOf& column_of) {
  add(expression, column_of);
}

void RowExpression::add(const text::Expression& expression, const ColumnOf& column_of) {
  for (const text::Expression& operand : expression.operands) add(operand, column_of);
  Instruction instruction{expression.kind, expression.function, expression.operands.size(),
                          expression.number};
  if (expression.kind == Node::name && (expression.name == "pi" || expression.name == "inf")) {
    instruction.kind = Node::number;
    instruction.number = text::evaluate(expression);
  } else if (expression.kind == Node::name) {
    instruction.count = column_of(expression);
    if (std::find(columns_.begin(), columns_.end(), instruction.count) == columns_.end())
      columns_.push_back(instruction.count);
  }
  depth_ = depth_ + 1 - expression.operands.size();
  deepest_ = std::max(deepest_, depth_ + expression.operands.size());
  instructions_.push_back(instruction);
}

void RowExpression::evaluate(std::span<const double* const> columns, std::span<double> values) const {
  for (std::size_t first = 0; first < values.size(); first += kBlock)
    evaluate_block(columns, first, values.subspan(first, std::min(kBlock, values.size() - first)));
}

double RowExpression::evaluate(std::span<const double> row) const {
  std::vector<const double*> columns(row.size());
  for (std::size_t c = 0; c < row.size(); ++c) columns[c] = &row[c];
  double value = 0;
  evaluate_block(columns, 0, {&value, 1});
  return value;
}

void RowExpression::evaluate_block(std::span<const double* const> columns, std::size_t first,
                                   std::span<double> values) const {
  const std::size_t n = values.size();
  std::vector<double> stack(deepest_ * n);
  std::vector<double> arguments;
  double* top = stack.data();  // one past the last operand
  for (const Instruction& at : instructions_) {
    if (at.kind == Node::number) {
      std::fill_n(top, n, at.number);
      top += n;
    } else if (at.kind == Node::name) {
      std::copy_n(columns[at.count] + first, n, top);
      top += n;
    } else {
      top -= at.count * n;
      const double* const second = at.count > 1 ? top + n : top;
      if (at.kind != Node::call) {
        for (std::size_t k = 0; k < n; ++k) top[k] = combine(at.kind, top[k], second[k]);
      } else {
        arguments.resize(at.count);
        for (std::size_t k = 0; k < n; ++k) {
          for (std::size_t i = 0; i < at.count; ++i) arguments[i] = top[i * n + k];
          top[k] = text::evaluate(at.function, arguments);
        }
      }
      top += n;
    }
  }
  std::copy_n(stack.data(), n, values.data());
}

}  // namespace oblique::ensemble
