// SPDX-License-Identifier: MIT
#include <oblique/mechanism/triad/triad_equation.h>

namespace oblique::mechanism::triad {
namespace {

/// Real trigonometric polynomial of degree 1: c₀ + Re(c₁z).
struct Wave {
  double constant = 0;
  Complex first;
};

TrigonometricCubic product(const Wave& a, const Wave& b) {
  return {a.constant * b.constant + dot(a.first, b.first) / 2,
          {a.constant * b.first + b.constant * a.first, a.first * b.first / 2.0, 0}};
}

TrigonometricCubic sum(const TrigonometricCubic& a, const TrigonometricCubic& b, double factor) {
  TrigonometricCubic result{a.constant + factor * b.constant, {}};
  for (std::size_t i = 0; i < 3; ++i) result.harmonics[i] = a.harmonics[i] + factor * b.harmonics[i];
  return result;
}

Wave right_hand_side(const Line& line) {
  return {line.w0, line.w1};
}

/// u_a × u_b
Wave determinant(const Line& a, const Line& b) {
  return {cross(a.u0, b.u0) + cross(a.u1, b.u1),
          -kQuarterTurn * (std::conj(a.u0) * b.u1 - a.u1 * std::conj(b.u0))};
}

}  // namespace

// |w_a u_b − w_b u_a|² − l²(u_a × u_b)²
Characteristic characteristic(const Line& a, const Line& b, double radius) {
  const Wave d = determinant(a, b);
  // m₋₁z⁻¹ + m₀ + m₁z + m₂z²
  const std::array<Complex, 4> m = {
      (std::conj(a.w1) * b.u0 - std::conj(b.w1) * a.u0) / 2.0,
      a.w0 * b.u0 - b.w0 * a.u0 + (std::conj(a.w1) * b.u1 - std::conj(b.w1) * a.u1) / 2.0,
      a.w0 * b.u1 - b.w0 * a.u1 + (a.w1 * b.u0 - b.w1 * a.u0) / 2.0, (a.w1 * b.u1 - b.w1 * a.u1) / 2.0};
  TrigonometricCubic square;
  for (const Complex& coefficient : m) square.constant += std::norm(coefficient);
  for (std::size_t shift = 1; shift < 4; ++shift) {
    for (std::size_t i = 0; i + shift < 4; ++i)
      square.harmonics[shift - 1] += 2.0 * m[i + shift] * std::conj(m[i]);
  }
  const double terms = (std::abs(a.w0) + modulus(a.w1)) * (modulus(b.u0) + modulus(b.u1)) +
                       (std::abs(b.w0) + modulus(b.w1)) * (modulus(a.u0) + modulus(a.u1));
  return {sum(square, product(d, d), -radius * radius), terms * terms + radius * radius};
}

// The determinant of the rows [u w].
Characteristic characteristic(const Line& a, const Line& b, const Line& c) {
  const Wave ab = determinant(a, b);
  const Wave bc = determinant(b, c);
  const Wave ca = determinant(c, a);
  Characteristic result;
  result.f = sum(sum(product(right_hand_side(a), bc), product(right_hand_side(b), ca), 1),
                 product(right_hand_side(c), ab), 1);
  for (const Line* line : {&a, &b, &c}) result.terms += std::abs(line->w0) + modulus(line->w1);
  return result;
}

}  // namespace oblique::mechanism::triad
