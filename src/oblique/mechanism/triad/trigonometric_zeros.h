// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>

namespace oblique::mechanism::triad {

/// Real trigonometric polynomial of degree 3: f(θ) = c₀ + Re(c₁z + c₂z² + c₃z³), z = e^{iθ}.
struct TrigonometricCubic {
  double constant = 0;
  std::array<std::complex<double>, 3> harmonics;

  /// |c₀| + |c₁| + |c₂| + |c₃|, a bound of |f|.
  double size() const;
};

/// Directions z = e^{iθ}.
struct Directions {
  std::array<std::complex<double>, 48> z;
  int count = 0;
};

/// Every zero of f, to about 1e-15 where it is a simple one, and every direction in which f comes to no more
/// than `negligible` without changing its sign (a double zero to rounding). Some may be named twice. f must
/// not be zero everywhere.
///
/// The circle is cut into arcs. On an arc of half-width r about its middle m, the k-th derivative has no zero
/// where
///
///     |f⁽ᵏ⁾(m)| > r|f⁽ᵏ⁺¹⁾(m)| + r²/2 |f⁽ᵏ⁺²⁾(m)| + r³/6 (|c₁| + 2ᵏ⁺³|c₂| + 3ᵏ⁺³|c₃|);
///
/// then f⁽ᵏ⁻¹⁾ has one zero at most, and between the zeros of one derivative the one before it is monotone,
/// down to f. So nothing is missed, and no direction is special. A zero of f is sixfold at most, so one of
/// the derivatives up to the sixth stays away from zero on a short enough arc.
Directions zeros(const TrigonometricCubic& f, double negligible);

}  // namespace oblique::mechanism::triad
