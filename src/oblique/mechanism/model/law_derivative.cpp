// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/law_derivative.h>

#include <utility>

#include <oblique/text/partial_derivative.h>

namespace oblique::mechanism {
namespace {

using Node = text::Expression::Kind;

text::Expression number(double value) {
  text::Expression e;
  e.number = value;
  return e;
}

bool is(const text::Expression& e, double value) {
  return e.kind == Node::number && e.number == value;
}

text::Expression node(Node kind, text::Expression a, text::Expression b) {
  text::Expression e;
  e.kind = kind;
  e.operands = {std::move(a), std::move(b)};
  return e;
}

text::Expression call(text::Function function, std::vector<text::Expression> operands) {
  text::Expression e;
  e.kind = Node::call;
  e.function = function;
  e.operands = std::move(operands);
  return e;
}

bool is_negation(const text::Expression& e) {
  return e.kind == Node::negate;
}

text::Expression negative(text::Expression a) {
  if (is(a, 0)) return a;
  text::Expression e;
  e.kind = Node::negate;
  e.operands = {std::move(a)};
  return e;
}

text::Expression difference(text::Expression a, text::Expression b) {
  if (is(b, 0)) return a;
  if (a.kind == Node::number && b.kind == Node::number) return number(a.number - b.number);
  if (is(a, 0)) return negative(std::move(b));
  return node(Node::subtract, std::move(a), std::move(b));
}

text::Expression sum(text::Expression a, text::Expression b) {
  if (is(a, 0)) return b;
  if (is(b, 0)) return a;
  if (is_negation(b)) return difference(std::move(a), std::move(b.operands[0]));
  return node(Node::add, std::move(a), std::move(b));
}

text::Expression quotient(text::Expression a, text::Expression b) {
  if (is(a, 0) || is(b, 1)) return a;
  return node(Node::divide, std::move(a), std::move(b));
}

text::Expression power(text::Expression a, text::Expression b) {
  if (is(b, 1)) return a;
  return node(Node::power, std::move(a), std::move(b));
}

/// What is negative or a quotient stays so: (1/x)·y is y/x.
text::Expression product(text::Expression a, text::Expression b) {
  if (is(a, 0) || is(b, 1)) return a;
  if (is(b, 0) || is(a, 1)) return b;
  if (is(a, -1)) return negative(std::move(b));
  if (is_negation(a)) return negative(product(std::move(a.operands[0]), std::move(b)));
  if (b.kind == Node::divide && is(b.operands[0], 1)) return quotient(std::move(a), std::move(b.operands[1]));
  if (a.kind == Node::divide && a.operands[0].kind == Node::number)
    return quotient(product(std::move(a.operands[0]), std::move(b)), std::move(a.operands[1]));
  if (a.kind != Node::number && a == b) return power(std::move(a), number(2));
  return node(Node::multiply, std::move(a), std::move(b));
}

/// An expression as what the table of operations writes derivatives of.
struct Formula {
  text::Expression e;
  int column;  ///< of what is differentiated

  Formula number(double value) const { return {mechanism::number(value), column}; }
  Formula apply(text::Operation operation, const Formula& second) const {
    return {applied(operation, second.e), column};
  }

 private:
  text::Expression applied(text::Operation operation, const text::Expression& b) const;
};

text::Expression Formula::applied(text::Operation operation, const text::Expression& b) const {
  switch (operation) {
    case text::Operation::add:
      return sum(e, b);
    case text::Operation::subtract:
      return difference(e, b);
    case text::Operation::multiply:
      return product(e, b);
    case text::Operation::divide:
      return quotient(e, b);
    case text::Operation::power:
      return power(e, b);
    case text::Operation::negate:
      return negative(e);
    case text::Operation::noise_derivative:
      break;
#define OBLIQUE_FUNCTION(name, operands, ...) \
  case text::Operation::name:                 \
    return operands == 1 ? call(text::Function::name, {e}) : call(text::Function::name, {e, b});
#include <oblique/text/operations.def>
  }
  throw text::ExpressionError{column, "the derivative of noise has no expression", {}, {}};
}

}  // namespace

text::Expression law_derivative(const text::Expression& law) {
  const auto operation = text::smooth_operation(law);
  if (!operation) {
    if (law.kind != Node::number && law.kind != Node::name)
      throw text::ExpressionError{law.column, "what switches has no derivative", {}, {}};
    return number(law.kind == Node::name && law.name == "time" ? 1 : 0);
  }
  const Formula f{law, law.column}, a{law.operands.front(), law.column}, b{law.operands.back(), law.column};
  text::Expression derivative = number(0);
  for (std::size_t i = 0; i < law.operands.size(); ++i) {
    const text::Expression rate = law_derivative(law.operands[i]);
    if (is(rate, 0)) continue;
    const Formula by_operand = text::partial_derivative(*operation, static_cast<int>(i), a, b, f);
    derivative = sum(std::move(derivative), product(by_operand.e, rate));
  }
  return derivative;
}

}  // namespace oblique::mechanism
