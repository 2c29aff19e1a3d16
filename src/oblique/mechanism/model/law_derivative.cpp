// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/law_derivative.h>

namespace oblique::mechanism {
namespace {

using Kind = text::Expression::Kind;

text::Expression number(double value) {
  text::Expression e;
  e.number = value;
  return e;
}

bool is(const text::Expression& e, double value) {
  return e.kind == Kind::number && e.number == value;
}

text::Expression node(Kind kind, text::Expression a, text::Expression b) {
  text::Expression e;
  e.kind = kind;
  e.operands = {std::move(a), std::move(b)};
  return e;
}

text::Expression call(text::Function function, text::Expression of) {
  text::Expression e;
  e.kind = Kind::call;
  e.function = function;
  e.operands = {std::move(of)};
  return e;
}

text::Expression negative(text::Expression a) {
  if (is(a, 0)) return a;
  text::Expression e;
  e.kind = Kind::negate;
  e.operands = {std::move(a)};
  return e;
}

text::Expression sum(text::Expression a, text::Expression b) {
  if (is(a, 0)) return b;
  if (is(b, 0)) return a;
  return node(Kind::add, std::move(a), std::move(b));
}

text::Expression difference(text::Expression a, text::Expression b) {
  if (is(a, 0)) return negative(std::move(b));
  if (is(b, 0)) return a;
  return node(Kind::subtract, std::move(a), std::move(b));
}

text::Expression product(text::Expression a, text::Expression b) {
  if (is(a, 0) || is(b, 1)) return a;
  if (is(b, 0) || is(a, 1)) return b;
  return node(Kind::multiply, std::move(a), std::move(b));
}

text::Expression quotient(text::Expression a, text::Expression b) {
  if (is(a, 0) || is(b, 1)) return a;
  return node(Kind::divide, std::move(a), std::move(b));
}

text::Expression square(const text::Expression& a) {
  return node(Kind::power, a, number(2));
}

text::Expression derivative_of_call(const text::Expression& e) {
  const text::Expression& x = e.operands[0];
  const text::Expression rate = law_derivative(x);
  switch (e.function) {
    case text::Function::sin:
      return product(call(text::Function::cos, x), rate);
    case text::Function::cos:
      return negative(product(call(text::Function::sin, x), rate));
    case text::Function::tan:
      return quotient(rate, square(call(text::Function::cos, x)));
    case text::Function::asin:
      return quotient(rate, call(text::Function::sqrt, difference(number(1), square(x))));
    case text::Function::acos:
      return negative(quotient(rate, call(text::Function::sqrt, difference(number(1), square(x)))));
    case text::Function::atan:
      return quotient(rate, sum(number(1), square(x)));
    case text::Function::exp:
      return product(e, rate);
    case text::Function::log:
      return quotient(rate, x);
    case text::Function::sqrt:
      return quotient(rate, product(number(2), e));
    case text::Function::atan2: {
      const text::Expression& w = e.operands[1];
      return quotient(difference(product(w, rate), product(x, law_derivative(w))), sum(square(x), square(w)));
    }
    default: {  // hypot, the last that `parse_law` lets through
      const text::Expression& w = e.operands[1];
      return quotient(sum(product(x, rate), product(w, law_derivative(w))), e);
    }
  }
}

text::Expression derivative_of_power(const text::Expression& e) {
  const text::Expression &base = e.operands[0], &exponent = e.operands[1];
  const text::Expression rate = law_derivative(exponent);
  text::Expression of_base = law_derivative(base);
  if (!is(of_base, 0)) {
    const text::Expression less =
        exponent.kind == Kind::number ? number(exponent.number - 1) : difference(exponent, number(1));
    const text::Expression lowered = is(less, 1) ? base : node(Kind::power, base, less);
    of_base = product(product(exponent, lowered), of_base);
  }
  if (is(rate, 0)) return of_base;
  return sum(of_base, product(product(e, call(text::Function::log, base)), rate));
}

}  // namespace

text::Expression law_derivative(const text::Expression& law) {
  if (law.kind == Kind::number) return number(0);
  if (law.kind == Kind::name) return number(law.name == "time" ? 1 : 0);
  if (law.kind == Kind::call) return derivative_of_call(law);
  if (law.kind == Kind::power) return derivative_of_power(law);
  const text::Expression& a = law.operands[0];
  const text::Expression rate = law_derivative(a);
  if (law.kind == Kind::negate) return negative(rate);
  const text::Expression& b = law.operands[1];
  const text::Expression other = law_derivative(b);
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

}  // namespace oblique::mechanism
