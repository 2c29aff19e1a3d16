// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include <oblique/text/operations.h>

// The derivatives of the table of operations, over whatever stands for a number: a double, a node of a graph,
// an expression.
namespace oblique::text {

/// What operations can be done on: it makes numbers and results of its own kind.
template <class X>
concept Operand = requires(const X& x) {
  { x.number(1.0) } -> std::same_as<X>;
  { x.apply(Operation::add, x) } -> std::same_as<X>;
};

// What the table writes its derivatives in: operators, and every operation under its name.
namespace table_language {

template <Operand X>
X operator-(const X& a) {
  return a.apply(Operation::negate, a);
}
template <Operand X>
X operator+(double a, const X& b) {
  return b.number(a).apply(Operation::add, b);
}
template <Operand X>
X operator+(const X& a, const X& b) {
  return a.apply(Operation::add, b);
}
template <Operand X>
X operator-(double a, const X& b) {
  return b.number(a).apply(Operation::subtract, b);
}
template <Operand X>
X operator-(const X& a, double b) {
  return a.apply(Operation::subtract, a.number(b));
}
template <Operand X>
X operator-(const X& a, const X& b) {
  return a.apply(Operation::subtract, b);
}
template <Operand X>
X operator*(double a, const X& b) {
  return b.number(a).apply(Operation::multiply, b);
}
template <Operand X>
X operator*(const X& a, const X& b) {
  return a.apply(Operation::multiply, b);
}
template <Operand X>
X operator/(double a, const X& b) {
  return b.number(a).apply(Operation::divide, b);
}
template <Operand X>
X operator/(const X& a, const X& b) {
  return a.apply(Operation::divide, b);
}

template <Operand X>
X call(Operation operation, const X& a) {
  return a.apply(operation, a);
}
template <Operand X>
X call(Operation operation, const X& a, const X& b) {
  return a.apply(operation, b);
}
#define OBLIQUE_OPERATION(name, ...)            \
  template <Operand X, class... Second>         \
  X name(const X& a, const Second&... second) { \
    return call(Operation::name, a, second...); \
  }
#include <oblique/text/operations.def>

template <Operand X>
X as_operand(const X& like, double value) {
  return like.number(value);
}
template <Operand X>
X as_operand(const X& /*like*/, const X& value) {
  return value;
}

template <Operand X>
X partial_derivative(Operation operation, int operand, const X& a, const X& b, const X& f) {
  switch (operation) {
#define OBLIQUE_OPERATION(name, operands, traits, value, by_a, by_b) \
  case Operation::name:                                              \
    return operand == 0 ? as_operand(f, by_a) : as_operand(f, by_b);
#include <oblique/text/operations.def>
  }
  return f.number(0);
}

}  // namespace table_language

/// The partial derivative of f = operation(a, b) by its first (0) or second (1) operand. Of an operation on
/// one operand, `b` is not looked at.
template <Operand X>
X partial_derivative(Operation operation, int operand, const X& a, const X& b, const X& f) {
  return table_language::partial_derivative(operation, operand, a, b, f);
}

}  // namespace oblique::text
