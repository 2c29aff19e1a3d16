// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include <oblique/mechanism/solver/complex_plane.h>
#include <oblique/mechanism/triad/triad.h>

namespace oblique::mechanism::triad {

/// A leg seen from the reference point, lengths divided by the group's size.
struct Condition {
  Leg::Kind kind = Leg::Kind::circle;
  Complex local, anchor;
  Complex normal;  ///< of a line, in its own frame
  double length = 0;
};

/// A pose of the platform: q the place of the reference point, z = e^{iθ}.
struct Pose {
  Complex q, z;
  bool singular = false;  ///< it closes and Newton knows no better: a dead centre
};

/// Turned by about δ, and on the unit circle.
Complex turned(Complex z, double delta);

/// The three conditions of a group, as equations that a pose fulfils or not.
class Closure {
 public:
  /// `rounding` is that of the given coordinates, relative to the group's size.
  Closure(const std::array<Condition, 3>& conditions, double rounding);

  /// The pose that Newton finds from `guess`, where it closes.
  std::optional<Pose> polished(const Pose& guess) const;

  /// Whether two poses are one to rounding: the one midway, put on the curve that the platform is free to
  /// follow, closes as they do.
  bool are_one(const Pose& a, const Pose& b) const;

  /// Whether poses close along the direction in which this one is free to first order, and not this one
  /// alone.
  bool lies_on_curve(const Pose& pose) const;

 private:
  void differentiate(const Pose& pose, Eigen::Vector3d& residual, Eigen::Matrix3d& jacobian) const;
  double rounding(const Pose& pose) const;

  std::array<Condition, 3> conditions_;
  double rounding_ = 0;
  double shortest_ = 1;  ///< of the circles' lengths, and 1
};

}  // namespace oblique::mechanism::triad
