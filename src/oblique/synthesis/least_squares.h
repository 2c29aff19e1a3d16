// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

namespace oblique::synthesis {

/// Σ rₖ(x)² to be made small within lower ≤ x ≤ upper.
struct LeastSquares {
  /// r(x), or nothing where it has no value.
  std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd&)> residuals;
  /// dr/dx where `residuals` has a value.
  std::function<Eigen::MatrixXd(const Eigen::VectorXd&)> jacobian;
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  double floor = 0;  ///< a sum below it is as good as zero
};

/// Where the search ended.
struct Minimum {
  Eigen::VectorXd x;
  double sum = 0;  ///< Σ rₖ²
  bool blocked =
      false;  ///< the last steps led where `residuals` has no value: x lies at an edge of its domain
};

/// Levenberg–Marquardt from `start`, projected onto the bounds: variables at a bound from which the gradient
/// points outwards rest, the others take the damped step, which is cut off at the bounds (Kanzow, Yamashita,
/// Fukushima, J. Comput. Appl. Math. 172 (2004) 375; damping after Nielsen, IMM-REP-1999-05). A bound is so
/// reached exactly and without the vanishing derivatives of a transformation. A step to where `residuals` has
/// no value is taken back and damped. Nothing where there is no value at `start`.
std::optional<Minimum> minimise(const LeastSquares& problem, const Eigen::VectorXd& start);

}  // namespace oblique::synthesis
