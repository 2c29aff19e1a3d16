// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/diagnostic.h>
#include <oblique/text/operations.h>

namespace oblique::text {

/// A parsed expression; a value type, one node and its operands.
struct Expression {
  // clang-format off
  enum class Kind {
    number, name, call,
    negate, add, subtract, multiply, divide, power,
    less, less_equal, greater, greater_equal, equal, not_equal, logical_and, logical_or, logical_not,
  };
  // clang-format on
  Kind kind = Kind::number;
  double number = 0;                  ///< for `number`
  std::string name;                   ///< for `name`; dots join the parts of a path ("tri.amp.out")
  Function function = Function::sin;  ///< for `call`
  std::vector<Expression> operands;
  int column = 0;  ///< of the operator or the first character, from 1; not part of the value

  bool operator==(const Expression& other) const;
};

/// The smooth operation at the root of an expression; nothing of a number, a name, a condition and what
/// switches.
std::optional<Operation> smooth_operation(const Expression& expression);

/// A malformed expression or one that has no value; `column` counts from 1 in the expression's text.
struct ExpressionError {
  int column = 0;
  std::string what;
  std::string expected;
  std::string remedy;
};

/// Value of a name inside a constant expression; `pi` and `inf` need no entry.
using NameLookup = std::function<std::optional<double>(std::string_view)>;

/// Value of an expression of constants. Throws ExpressionError for a name that `lookup` does not know.
double evaluate(const Expression& expression, const NameLookup& lookup = {});

/// True for an identifier: `[A-Za-z_][A-Za-z0-9_]*`.
bool is_identifier(std::string_view text);

}  // namespace oblique::text
