// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <optional>

#include <Eigen/Dense>

namespace oblique::solve {

/// The loops that dynamic elements of a linear system close, each cut open in turn.
///
/// A servo amplifier τ ẋ = −x − μ r reads its own output twice: in −x, which is its own pole p₀ = −1/τ and is
/// inside the amplifier, and in the residual r, through the diagram. The loop that the diagram closes is the
/// second. With its output cut there, v taking its place in all that others read, the i-th row of ẋ = A x is
///
///     s x_i = p₀ x_i + (a_ii − p₀) v + Σ_{j≠i} a_ij x_j,      s x_j = a_ji v + Σ_{k≠i} a_jk x_k,
///
/// so the loop gain of negative feedback is, all other elements closed,
///
///     L(s) = −x_i/v = −[(a_ii − p₀) + a_i* (s − A_**)⁻¹ a_*i]/(s − p₀),
///
/// which has the amplifier's own pole, and 1 + L(s) = 0 exactly at the eigenvalues of A. A cut at the
/// amplifier's input gives the same: it is one signal on one path. For a lone amplifier L(s) = μ (∂r/∂x)/(1 +
/// τ s), the open loop of every textbook, and L(0) = μ ∂r/∂x is the gain whose inverse is the static error.
/// Since (s − A)⁻¹_ii = 1/((s − p₀)(1 + L(s))), a Schur form of A gives L for every element and s.
class OpenLoops {
 public:
  /// `a` is the matrix A of elements that act on each other [1/s].
  explicit OpenLoops(const Eigen::MatrixXd& a);

  /// L(s) of the element in row `place` with its own pole `own_pole` [1/s]. Infinite where 1 + L has a pole.
  std::complex<double> gain(Eigen::Index place, double own_pole, std::complex<double> s) const;

  /// The gain crossover with the smallest phase margin.
  struct Margin {
    /// 180° + arg L: how much more lag the loop bears, in (0°, 360°) where it is stable. A loop that is
    /// unstable is told what it lacks: in (−180°, 180°].
    double degrees = 0;
    double frequency = 0;  ///< where |L| = 1 [rad/s]
  };
  /// Nothing where |L| never passes 1. Crossovers are sought on a logarithmic grid around all poles, 20
  /// points a decade, and refined to rounding. A conditionally stable loop has several, and only from
  /// whether it is `unstable` follows what they mean.
  std::optional<Margin> phase_margin(Eigen::Index place, double own_pole, bool unstable) const;
  /// The same, unstable where A has an eigenvalue right of the imaginary axis.
  std::optional<Margin> phase_margin(Eigen::Index place, double own_pole) const;

 private:
  Eigen::MatrixXcd vectors_;  ///< A = U T U*
  Eigen::MatrixXcd triangle_;
};

}  // namespace oblique::solve
