// SPDX-License-Identifier: MIT
#include <oblique/text/expression_printer.h>

#include <cmath>

#include <fmt/format.h>

#include <oblique/text/expression_grammar.h>

namespace oblique::text {
namespace {

int precedence_of(const Expression& e) {
  switch (e.kind) {
    case Expression::Kind::negate:
      return kNegation;
    case Expression::Kind::logical_not:
      return kNot;
    case Expression::Kind::number:
      return std::signbit(e.number) ? kNegation : kAtom;
    case Expression::Kind::name:
    case Expression::Kind::call:
      return kAtom;
    default:
      return operator_of(e.kind)->precedence;
  }
}

bool is_unsigned_number(const Expression& e) {
  return e.kind == Expression::Kind::number && !std::signbit(e.number);
}

void print(const Expression& e, std::string& out);

void print_operand(const Expression& e, int at_least, std::string& out) {
  const bool wrap = precedence_of(e) < at_least;
  if (wrap) out += '(';
  print(e, out);
  if (wrap) out += ')';
}

void print(const Expression& e, std::string& out) {
  switch (e.kind) {
    case Expression::Kind::number:
      out += fmt::format("{}", e.number);
      return;
    case Expression::Kind::name:
      out += e.name;
      return;
    case Expression::Kind::call:
      out += info_of(e.function).name;
      for (std::size_t i = 0; i < e.operands.size(); ++i) {
        out += i == 0 ? "(" : ", ";
        print(e.operands[i], out);
      }
      out += ')';
      return;
    case Expression::Kind::negate:
      out += '-';
      // "-2" would be the number, not the negation of 2.
      print_operand(e.operands[0], is_unsigned_number(e.operands[0]) ? kAtom + 1 : kNegation, out);
      return;
    case Expression::Kind::logical_not:
      out += "not ";
      print_operand(e.operands[0], kNot, out);
      return;
    default:
      break;
  }
  const BinaryOperator& op = *operator_of(e.kind);
  const bool tight = op.precedence == kProduct || op.precedence == kPower;
  const bool power = op.precedence == kPower;
  const bool chains = op.precedence != kComparison;
  print_operand(e.operands[0], power ? kAtom : op.precedence + (chains ? 0 : 1), out);
  out += tight ? std::string(op.text) : fmt::format(" {} ", op.text);
  print_operand(e.operands[1], power ? kNegation : op.precedence + 1, out);
}

}  // namespace

std::string to_string(const Expression& expression) {
  std::string out;
  print(expression, out);
  return out;
}

}  // namespace oblique::text
