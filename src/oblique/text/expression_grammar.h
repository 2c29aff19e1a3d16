// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include <oblique/text/expression.h>

// What the parser and the printer of expressions must agree on. Not installed.
namespace oblique::text {

/// Binary operators by precedence; `^` binds tightest and to the right, everything else to the left.
enum Precedence { kOr = 1, kAnd, kNot, kComparison, kSum, kProduct, kNegation, kPower, kAtom };

/// A binary operator as it is written.
struct BinaryOperator {
  std::string_view text;
  Expression::Kind kind;
  int precedence;
};

// Longer spellings first: "<=" is not "<".
// Of those that mean the same, the one that is printed comes first; the others are pasted from typeset text.
inline constexpr std::array<BinaryOperator, 17> kBinaryOperators{{
    {"<=", Expression::Kind::less_equal, kComparison},
    {">=", Expression::Kind::greater_equal, kComparison},
    {"==", Expression::Kind::equal, kComparison},
    {"!=", Expression::Kind::not_equal, kComparison},
    {"<", Expression::Kind::less, kComparison},
    {">", Expression::Kind::greater, kComparison},
    {"+", Expression::Kind::add, kSum},
    {"-", Expression::Kind::subtract, kSum},
    {"\u2212", Expression::Kind::subtract, kSum},
    {"\u2013", Expression::Kind::subtract, kSum},
    {"*", Expression::Kind::multiply, kProduct},
    {"·", Expression::Kind::multiply, kProduct},
    {"×", Expression::Kind::multiply, kProduct},
    {"/", Expression::Kind::divide, kProduct},
    {"^", Expression::Kind::power, kPower},
    {"or", Expression::Kind::logical_or, kOr},
    {"and", Expression::Kind::logical_and, kAnd},
}};

/// The operator that makes nodes of this kind, or nothing.
const BinaryOperator* operator_of(Expression::Kind kind);

/// The function of this name, or nothing.
const FunctionInfo* find_function(std::string_view name);

/// The bytes of the minus sign or dash that begins at `at`, and of the space, the typographic ones included;
/// 0 where there is none.
std::size_t minus_at(std::string_view text, std::size_t at);
std::size_t space_at(std::string_view text, std::size_t at);

inline bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace oblique::text
