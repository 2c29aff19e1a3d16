// SPDX-License-Identifier: MIT
#pragma once

// Not installed.
namespace oblique::ensemble {

/// An explicit Runge–Kutta method of order 7 in 10 stages for u′ = F(t, u), with an embedded one of order 6;
/// with six more stages a polynomial of order 7 between the ends of a step (J. H. Verner, "Numerically
/// optimal Runge–Kutta pairs with interpolants", Numerical Algorithms 53:383, 2010; the pair that he names
/// most efficient).
///
///     kᵢ = F(t + cᵢ h, u + h Σ aᵢⱼ kⱼ),   u + h Σ bᵢ kᵢ is the result, h Σ errorᵢ kᵢ the error,
///     u + h Σ kᵢ (betweenᵢ₁ θ + … + betweenᵢ₇ θ⁷) what is at t + θ h, with all stages.
struct Verner7 {
  static constexpr int kStages = 10, kAllStages = 16, kPowers = 7;
  static const double c[kAllStages];
  static const double a[kAllStages][kAllStages];
  static const double b[kStages];
  static const double error[kStages];
  static const double between[kAllStages][kPowers];
};

}  // namespace oblique::ensemble
