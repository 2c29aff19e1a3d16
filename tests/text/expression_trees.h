// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <oblique/text/expression.h>
#include <oblique/text/expression_parser.h>

namespace oblique::test {

// Trees that are built by hand: the oracle of what a text means.

inline text::Expression number(double value) {
  text::Expression e;
  e.number = value;
  return e;
}

inline text::Expression name(std::string path) {
  text::Expression e;
  e.kind = text::Expression::Kind::name;
  e.name = std::move(path);
  return e;
}

inline text::Expression node(text::Expression::Kind kind, std::vector<text::Expression> operands) {
  text::Expression e;
  e.kind = kind;
  e.operands = std::move(operands);
  return e;
}

inline text::Expression call(text::Function function, std::vector<text::Expression> operands) {
  text::Expression e = node(text::Expression::Kind::call, std::move(operands));
  e.function = function;
  return e;
}

inline double value_of(std::string_view text) {
  return text::evaluate(text::parse_expression(text));
}

/// The whole message of a malformed expression: "column: what; expected …; remedy".
inline std::string message_of(std::string_view text) {
  try {
    text::evaluate(text::parse_expression(text));
  } catch (const text::ExpressionError& error) {
    std::string message = std::to_string(error.column) + ": " + error.what;
    if (!error.expected.empty()) message += "; expected " + error.expected;
    if (!error.remedy.empty()) message += "; " + error.remedy;
    return message;
  }
  return "no error";
}

}  // namespace oblique::test
