// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace oblique {

/// Point k = 1, 2, … of the unit cube; they are spread evenly however many are taken: the additive recurrence
/// frac(½ + k/gⁱ), g the root of gⁿ⁺¹ = g + 1 (M. Roberts, "The unreasonable effectiveness of quasirandom
/// sequences", 2018).
Eigen::VectorXd spread_point(Eigen::Index dimensions, int k);

}  // namespace oblique
