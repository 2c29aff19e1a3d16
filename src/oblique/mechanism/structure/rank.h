// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// Where a link stands: the place of its first point and its direction.
struct BodyPose {
  Eigen::Vector2d position;
  double cosine = 1, sine = 0;
};

std::vector<BodyPose> poses_of(const Mechanism& mechanism, const Configuration& here);

/// Derivatives of all pair conditions, drives apart, by the coordinates of all links: x, y and angle times
/// the largest length of each. Two rows for a revolute joint between a link and the frame or the first link
/// that names the point, one for a pin in a slot, two for a prismatic pair.
Eigen::MatrixXd pair_jacobian(const Mechanism& mechanism, const std::vector<BodyPose>& poses);

/// Degrees of freedom by the rank of `pair_jacobian`: singular values below kRankTolerance of the largest
/// count as zero. The root of the rounding, 1e-8, is what the position of a dead centre is known to.
struct JacobianRank {
  std::size_t coordinates = 0, conditions = 0, rank = 0;
  double least_kept = 0;    ///< smallest singular value that counts, over the largest
  double largest_lost = 0;  ///< largest that does not
  int mobility() const { return static_cast<int>(coordinates) - static_cast<int>(rank); }
  /// By Grübler's formula: if all conditions were independent.
  int gruebler() const { return static_cast<int>(coordinates) - static_cast<int>(conditions); }
};
inline constexpr double kRankTolerance = 1e-6;

/// Links without a place (NaN) and their conditions are left out.
JacobianRank jacobian_rank(const Mechanism& mechanism, const std::vector<BodyPose>& poses);

/// Mobility by Grübler's formula and by rank. Where they differ at the start, a second position is looked
/// at, 5° of the fastest drive on (or back, where that is beyond a limit).
struct MobilityReport {
  enum class Verdict {
    agrees,
    shaky,            ///< the rank is lower at the start only: a dead centre or change point
    overconstrained,  ///< it is lower everywhere: some conditions are redundant
  };
  int gruebler = 0;
  JacobianRank start;
  std::optional<JacobianRank> beside;
  Verdict verdict = Verdict::agrees;
};

MobilityReport mobility_report(const Mechanism& mechanism, const Structure& structure);

}  // namespace oblique::mechanism
