// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/solver/complex_plane.h>
#include <oblique/mechanism/triad/trigonometric_zeros.h>

namespace oblique::mechanism::triad {

/// A condition linear in the position q of a platform whose direction is z = e^{iθ}: u(z)·q = w(z) with
/// u = u₀ + u₁z and w = w₀ + Re(w₁z).
struct Line {
  Complex u0, u1;
  double w0 = 0;
  Complex w1;

  Complex u(Complex z) const { return u0 + u1 * z; }
  double w(Complex z) const { return w0 + dot(std::conj(w1), z); }
};

/// The q that fulfils both, u_a × u_b = `determinant` not being zero.
inline Complex crossing(const Line& a, const Line& b, Complex z, double determinant) {
  return -kQuarterTurn * (a.w(z) * b.u(z) - b.w(z) * a.u(z)) / determinant;
}

/// F(θ), whose zeros are the directions in which a platform may close.
struct Characteristic {
  TrigonometricCubic f;
  double terms = 0;  ///< size of what F is the difference of: its rounding is that of these
};

/// Of two lines and the circle |q| = radius.
Characteristic characteristic(const Line& a, const Line& b, double radius);

/// Of three lines.
Characteristic characteristic(const Line& a, const Line& b, const Line& c);

}  // namespace oblique::mechanism::triad
