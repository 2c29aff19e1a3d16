// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <Eigen/Core>

namespace oblique::mechanism {

/// The conditions g(q, t) = 0 of a group beside a pose at which their Jacobian J is nearly singular, reduced
/// to the one that decides (Lyapunov and Schmidt). With the singular vectors u, v of the least singular value
/// σ, and p = −J⁺ ∂g/∂t without them, the poses at a time τ from here are q + s v + τ p + O(2), where
///
///     φ(s, τ) = σ s + a τ + ½ (A s² + 2 B s τ + C τ²) = 0,     a = u·∂g/∂t
///
/// and A, B, C are u times the second derivatives along v and p. What is left out is of third order. A curve
/// of second degree: where it turns back in τ is a limit; where it is two lines that cross, φ = ∂φ/∂s = ∂φ/∂τ
/// = 0 and B² > A C, two modes cross, and each has its own velocity.
struct Singularity {
  double sigma = 0;       ///< σ ≥ 0
  double drive = 0;       ///< a [length/s]
  double ss = 0;          ///< A [1/length]
  double st = 0;          ///< B [1/s]
  double tt = 0;          ///< C [length/s²]
  Eigen::VectorXd along;  ///< v
  Eigen::VectorXd drift;  ///< p [length/s]
  double rounding = 0;    ///< up to which φ counts as 0 [length]
  double size = 1;        ///< of the group [length]
  double seconds = 1;     ///< in which the drives make a way of the order of 1

  /// Two modes that cross.
  struct Crossing {
    double time = 0;   ///< τ where they meet [s]
    double along = 0;  ///< s there
    double apart = 0;  ///< how fast they go apart [length/s]
  };

  /// The time τ at which this branch turns back, on the way to times of the sign of `way`; nothing where it
  /// goes on.
  std::optional<double> fold(double way) const;

  /// The crossing nearby: nothing where the second order is not of two lines, or the curve misses it by more
  /// than rounding.
  std::optional<Crossing> crossing() const;

  /// s of this branch at τ, which lies before a fold.
  double branch(double tau) const;
};

}  // namespace oblique::mechanism
