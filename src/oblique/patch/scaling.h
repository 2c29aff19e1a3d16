// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::patch {

/// What the exact motion tells about one dyad's triangle P–Q–C over the turn.
struct TriangleRange {
  double shortest = 0;  ///< smallest distance P–Q [length unit]
  double longest = 0;   ///< largest [length unit]
  double flattest = 1;  ///< smallest sin γ at P: the second loop's gain falls to this
};

/// The amplitude scaling of a patch, from the exact motion.
struct Scaling {
  /// From where coordinates count [length unit]: a point of the frame, so that a mechanism far from [0, 0]
  /// fills the machine all the same.
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double length = 1;                     ///< 1 machine unit of a coordinate [length unit]
  std::vector<TriangleRange> triangles;  ///< one for each group of the structure; unused for cranks
  std::vector<double>
      slides;  ///< largest distance of each prismatic joint's point from where its line begins [length unit]
};

/// Smallest of 1, 2, 4, 5, 8, 10 times a power of ten that is not below `value`: lengths divided by it stay
/// short decimal numbers.
double round_scale_up(double value);

/// Smallest number of three significant digits that is not below `value`.
double round_up(double value);

/// Finds the scaling from a motion over one turn. Throws PatchError where there is an obstacle on the way:
/// there a triangle is collinear or cannot be assembled.
Scaling find_scaling(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                     const mechanism::Motion& motion);

}  // namespace oblique::patch
