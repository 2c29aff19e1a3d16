// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <complex>

namespace oblique::mechanism::triad {

/// A vector of the plane as a complex number: a turn is a product.
using Complex = std::complex<double>;

constexpr Complex kQuarterTurn(0, 1);

inline double dot(Complex a, Complex b) {
  return a.real() * b.real() + a.imag() * b.imag();
}

inline double cross(Complex a, Complex b) {
  return a.real() * b.imag() - a.imag() * b.real();
}

/// |a| where its square is a number; std::abs guards that, at four times the cost.
inline double modulus(Complex a) {
  return std::sqrt(std::norm(a));
}

}  // namespace oblique::mechanism::triad
