// SPDX-License-Identifier: MIT
#include <oblique/mechanism/law_derivative.h>

namespace oblique {
namespace {

using Kind = Expression::Kind;

Expression number(double value) {
  Expression e;
  e.number = value;
  return e;
}

bool is(const Expression& e, double value) {
  return e.kind == Kind::number && e.number == value;
}

Expression node(Kind kind, Expression a, Expression b) {
  Expression e;
  e.kind = kind;
  e.operands = {std::move(a), std::move(b)};
  return e;
}

Expression call(Function function, Expression of) {
  Expression e;
  e.kind = Kind::call;
  e.function = function;
  e.operands = {std::move(of)};
  return e;
}

Expression negative(Expression a) {
  if (is(a, 0)) return a;
  Expression e;
  e.kind = Kind::negate;
  e.operands = {std::move(a)};
  return e;
}

Expression sum(Expression a, Expression b) {
  if (is(a, 0)) return b;
  if (is(b, 0)) return a;
  return node(Kind::add, std::move(a), std::move(b));
}

Expression difference(Expression a, Expression b) {
  if (is(a, 0)) return negative(std::move(b));
  if (is(b, 0)) return a;
  return node(Kind::subtract, std::move(a), std::move(b));
}

Expression product(Expression a, Expression b) {
  if (is(a, 0) || is(b, 1)) return a;
  if (is(b, 0) || is(a, 1)) return b;
  return node(Kind::multiply, std::move(a), std::move(b));
}

Expression quotient(Expression a, Expression b) {
  if (is(a, 0) || is(b, 1)) return a;
  return node(Kind::divide, std::move(a), std::move(b));
}

Expression square(const Expression& a) {
  return node(Kind::power, a, number(2));
}

Expression derivative_of_call(const Expression& e) {
  const Expression& x = e.operands[0];
  const Expression rate = law_derivative(x);
  switch (e.function) {
    case Function::sin:
      return product(call(Function::cos, x), rate);
    case Function::cos:
      return negative(product(call(Function::sin, x), rate));
    case Function::tan:
      return quotient(rate, square(call(Function::cos, x)));
    case Function::asin:
      return quotient(rate, call(Function::sqrt, difference(number(1), square(x))));
    case Function::acos:
      return negative(quotient(rate, call(Function::sqrt, difference(number(1), square(x)))));
    case Function::atan:
      return quotient(rate, sum(number(1), square(x)));
    case Function::exp:
      return product(e, rate);
    case Function::log:
      return quotient(rate, x);
    case Function::sqrt:
      return quotient(rate, product(number(2), e));
    case Function::atan2: {
      const Expression& w = e.operands[1];
      return quotient(difference(product(w, rate), product(x, law_derivative(w))), sum(square(x), square(w)));
    }
    default: {  // hypot, the last that `parse_law` lets through
      const Expression& w = e.operands[1];
      return quotient(sum(product(x, rate), product(w, law_derivative(w))), e);
    }
  }
}

Expression derivative_of_power(const Expression& e) {
  const Expression &base = e.operands[0], &exponent = e.operands[1];
  const Expression rate = law_derivative(exponent);
  Expression of_base = law_derivative(base);
  if (!is(of_base, 0)) {
    const Expression less =
        exponent.kind == Kind::number ? number(exponent.number - 1) : difference(exponent, number(1));
    const Expression lowered = is(less, 1) ? base : node(Kind::power, base, less);
    of_base = product(product(exponent, lowered), of_base);
  }
  if (is(rate, 0)) return of_base;
  return sum(of_base, product(product(e, call(Function::log, base)), rate));
}

}  // namespace

Expression law_derivative(const Expression& law) {
  if (law.kind == Kind::number) return number(0);
  if (law.kind == Kind::name) return number(law.name == "time" ? 1 : 0);
  if (law.kind == Kind::call) return derivative_of_call(law);
  if (law.kind == Kind::power) return derivative_of_power(law);
  const Expression& a = law.operands[0];
  const Expression rate = law_derivative(a);
  if (law.kind == Kind::negate) return negative(rate);
  const Expression& b = law.operands[1];
  const Expression other = law_derivative(b);
  switch (law.kind) {
    case Kind::add:
      return sum(rate, other);
    case Kind::subtract:
      return difference(rate, other);
    case Kind::multiply:
      return sum(product(rate, b), product(a, other));
    default:  // a quotient
      if (is(other, 0)) return quotient(rate, b);
      return quotient(difference(product(rate, b), product(a, other)), square(b));
  }
}

}  // namespace oblique
