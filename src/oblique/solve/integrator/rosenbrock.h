// SPDX-License-Identifier: MIT
#pragma once

// Not installed.
namespace oblique::solve {

/// Rodas5P: a linearly implicit (Rosenbrock) method of order 5 in 8 stages for M u′ = F(t, u), with an
/// embedded one of order 4 and a polynomial of order 4 between the ends of a step. Stiffly accurate, so that
/// algebraic unknowns come out as exactly as states (G. Steinebach, "Construction of Rosenbrock–Wanner method
/// Rodas5P and numerical benchmarks within the Julia Differential Equations package", BIT 63:27, 2023).
///
/// With W = M/(hγ) − ∂F/∂u, for i = 1 … 8 (Hairer & Wanner II, IV.7.25):
///
///     W kᵢ = F(t + cᵢ h, u + Σ aᵢⱼ kⱼ) + M Σ (Cᵢⱼ/h) kⱼ + h dᵢ ∂F/∂t,
///
/// the last three stages each begin where the last ended; u + … + k₈ is the result, and k₈ the error.
struct Rodas5p {
  static constexpr int kStages = 8;
  static constexpr double kGamma = 0.21193756319429014;
  static const double c[kStages];
  static const double d[kStages];           ///< of stages from the sixth on 0
  static const double a[kStages][kStages];  ///< of the first six; the others add the last stage to its place
  static const double C[kStages][kStages];  // NOLINT(readability-identifier-naming): as in the formula
  static const double between[3][kStages];  ///< coefficients of the polynomial between the ends
};

}  // namespace oblique::solve
