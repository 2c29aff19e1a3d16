// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include <Eigen/Core>

namespace oblique::mechanism {

/// One condition that a leg puts on the pose of a platform. World points p = position + R·local.
struct Leg {
  enum class Kind {
    circle,         ///< RR: the platform's point `local` lies at `length` from `anchor`
    fixed_line,     ///< PR: the platform's point `local` lies on the line through `anchor` along `direction`
    platform_line,  ///< RP: `anchor` lies on the platform's line through `local` along `direction`
  };
  Kind kind = Kind::circle;
  Eigen::Vector2d local = Eigen::Vector2d::Zero();   ///< in the platform's frame [length unit]
  Eigen::Vector2d anchor = Eigen::Vector2d::Zero();  ///< in the world's frame [length unit]
  Eigen::Vector2d direction =
      Eigen::Vector2d::UnitX();  ///< unit vector; of the world (PR), of the platform (RP)
  double length = 0;             ///< > 0 for a circle [length unit]
};

/// Where the platform's frame is: R = (cosine −sine; sine cosine).
struct PlatformPose {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of its origin [length unit]
  double cosine = 1, sine = 0;
};

struct PlatformModes {
  std::array<PlatformPose, 8> poses;  ///< the first `count`, by angle in (−π, π], then by position
  int count = 0;
  /// The conditions depend on each other: a whole curve of poses closes, to 1e-12 of the group's size along a
  /// stretch of a tenth of it. None of these is in `poses`, which holds the isolated ones.
  bool movable = false;
};

/// Every pose that three legs allow a platform (the assembly modes of a triad, Assur's group of class III):
/// up to 6 with circles among the legs, up to 4 without.
///
/// Each condition but one is linear in the position q(θ) of the reference point: uᵢ(θ)·q = wᵢ(θ); circles
/// become so by subtracting the reference circle |q| = l. By Cramer's rule q = N/D, and the angles are the
/// zeros of a trigonometric polynomial of degree 3 at most,
///
///     F(θ) = N_x² + N_y² − l²D²,   or without any circle   F(θ) = det [uᵢ wᵢ].
///
/// Every zero is carried to poses, polished by Newton on the three conditions themselves, and kept where
/// these close to 1e-13 of the group's size (plus the rounding of the given coordinates); zeros that belong
/// to no pose fall out here (C. Gosselin and J.-P. Merlet, "The direct kinematics of planar parallel
/// manipulators: special architectures and number of solutions", Mechanism and Machine Theory 29, 1994).
///
/// A dead centre is a double zero; rounding moves its two poses apart by some 1e-8, or makes them complex. A
/// pose that closes as said counts as real; two count as one where the pose midway closes to rounding, or
/// where one of them is singular and within 1e-5 (of the size, or rad) of the other. So a dead centre is not
/// lost: it is named once or twice. Where more than two modes meet they are known, and told apart, to some
/// 1e-4 only. Poses farther out than 1e4 sizes, where lines are as good as parallel, are left out.
PlatformModes platform_modes(const std::array<Leg, 3>& legs);

}  // namespace oblique::mechanism
