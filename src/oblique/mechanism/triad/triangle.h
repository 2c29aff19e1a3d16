// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::mechanism {

/// A triangle is collinear where its slack is within this, for coordinates and sides up to `size`.
/// Coordinates of known points carry a few roundings of their size each, and more behind several groups; 32
/// of them leave every angle between the links whose sine is above about 2e-7 to the regular case.
inline double flat_within(double size) {
  return 32 * std::numeric_limits<double>::epsilon() * size;
}

/// The oblique triangle over a base: where its apex lies, from three side lengths.
struct Triangle {
  double along = 0;      ///< of the apex, from the base's first end along the base
  double height = 0;     ///< of the apex over the base, ≥ 0; 0 for a collinear or impossible triangle
  double four_area = 0;  ///< 4·area = √((r₁+r₂)²−L²)(L²−(r₁−r₂)²), ≥ 0
  double slack = 0;  ///< min(r₁+r₂−L, L−|r₁−r₂|): negative where the sides do not reach each other
};

/// Triangle with base L > 0, side r₁ at the base's first end and r₂ at its second.
///
///     along = (L² + r₁² − r₂²) / 2L,   height = √((r₁+r₂+L)(r₁+r₂−L)(L+r₁−r₂)(L−r₁+r₂)) / 2L
///
/// Heron's products instead of 1 − cos² keep the height accurate to rounding of the *lengths* even where the
/// triangle is nearly collinear (W. Kahan, "Miscalculating Area and Angles of a Needle-like Triangle").
inline Triangle triangle(double base, double first, double second) {
  const double sum = first + second;
  const double difference = first - second;
  const double beyond = sum - base;
  const double within = base - std::abs(difference);
  Triangle result;
  result.slack = std::min(beyond, within);
  const double inverse = 1 / base;  // one division for all: divisions are what a triangle costs
  result.along = (base + difference * sum * inverse) / 2;
  if (result.slack > 0) {
    // two roots, since the product of four lengths leaves the range of numbers at 1e78 and at 1e-82
    result.four_area = std::sqrt((sum + base) * (base + std::abs(difference))) * std::sqrt(beyond * within);
    result.height = result.four_area * inverse / 2;
  }
  return result;
}

}  // namespace oblique::mechanism
