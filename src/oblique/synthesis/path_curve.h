// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/motion/motion.h>

namespace oblique::synthesis {

/// The path of a point between the rows of a motion: polynomials of fifth degree in time with the rows'
/// positions, velocities and accelerations (Hermite). Their error is h⁶ p⁽⁶⁾/46080 for rows h apart; with 360
/// rows a turn that is rounding for all but the sharpest turns of a path. There is no path between rows that
/// are not both `ok`.
class PathCurve {
 public:
  PathCurve(const mechanism::Motion& motion, std::size_t point);

  /// The place of the path nearest to a target.
  struct Foot {
    double time = 0;             ///< [s]
    Eigen::Vector2d difference;  ///< path − target [length unit]
    /// What part of a small move of the path changes the distance: that along the normal, or all of it at an
    /// end of the path, at a cusp.
    Eigen::Matrix2d projector;
  };

  /// Nothing where there is no path at all.
  std::optional<Foot> nearest(const Eigen::Vector2d& target) const;

  /// The place at a time within the motion, if there is a path.
  std::optional<Eigen::Vector2d> at(double time) const;

 private:
  struct Piece {
    double begin = 0;                          ///< [s]
    double duration = 0;                       ///< [s]
    Eigen::Matrix<double, 2, 6> coefficients;  ///< of powers of s = (t − begin)/duration

    Eigen::Vector2d position(double s) const;
    Eigen::Vector2d tangent(double s) const;  ///< d position/ds
    double nearest(const Eigen::Vector2d& target) const;
  };

  std::vector<Piece> pieces_;  ///< in the order of time
};

}  // namespace oblique::synthesis
