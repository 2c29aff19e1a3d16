// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace oblique::report {

/// A term of a sum: a number times factors over divisors, each as it is printed. Not installed.
struct Monomial {
  double coefficient = 1;
  std::vector<std::string> factors, divisors;
};

/// The same sum in reading order, without two terms alike and without terms of nothing.
std::vector<Monomial> merged(std::vector<Monomial> terms);

/// "28*X - Y - X*Z"; "0" where there is no term. Numbers have `digits` significant digits.
std::string sum_text(const std::vector<Monomial>& terms, int digits);

/// With `digits` significant digits; nothing has no sign.
std::string number_text(double value, int digits);

}  // namespace oblique::report
