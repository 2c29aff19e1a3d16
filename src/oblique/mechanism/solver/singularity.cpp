// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/singularity.h>

#include <cmath>

namespace oblique::mechanism {

// φ = 0 has an s where P(τ) = D τ² − 2 m τ + σ² ≥ 0, with D = B² − A C and m = a A − σ B; it turns back at
// the zeros of P. Both lie at m/D where two lines cross.

std::optional<double> Singularity::fold(double way) const {
  const double d = st * st - ss * tt, m = drive * ss - sigma * st;
  const double rest = m * m - d * sigma * sigma;
  if (!(rest >= 0)) return std::nullopt;
  const double sum = m + std::copysign(std::sqrt(rest), m);
  std::optional<double> nearest;
  for (const double tau : {sigma * sigma / sum, sum / d}) {
    if (!std::isfinite(tau) || tau * way < 0) continue;
    if (!nearest || std::abs(tau) < std::abs(*nearest)) nearest = tau;
  }
  return nearest;
}

std::optional<Singularity::Crossing> Singularity::crossing() const {
  const double d = st * st - ss * tt;
  // how sharply the lines cross, in numbers without units; the derivatives have some ten digits
  constexpr double kSharp = 1e-8;
  const double a = ss * size, b = st * seconds, c = tt * seconds * seconds / size;
  if (!(b * b - a * c > kSharp * (a * a + b * b + c * c))) return std::nullopt;
  Crossing crossing;
  crossing.time = (drive * ss - sigma * st) / d;
  crossing.along = (sigma * tt - drive * st) / d;
  const double value =
      (sigma * crossing.along + drive * crossing.time) / 2;  // of φ, where it does not change
  if (!(std::abs(value) <= rounding)) return std::nullopt;
  crossing.apart = 2 * std::sqrt(d) / std::abs(ss);
  return crossing;
}

double Singularity::branch(double tau) const {
  const double d = st * st - ss * tt, m = drive * ss - sigma * st;
  const double root = std::sqrt(std::max(0.0, (d * tau - 2 * m) * tau + sigma * sigma));
  return -(2 * drive + tt * tau) * tau / (sigma + st * tau + root);
}

}  // namespace oblique::mechanism
