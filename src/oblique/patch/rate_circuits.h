// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/patch/circuit.h>

namespace oblique::patch {

/// The signals of a point's velocity and acceleration.
struct RateSignals {
  std::string vx, vy, ax, ay;
};

struct RateCircuits {
  std::vector<RateSignals> points;
  double velocity_unit = 1;      ///< 1 machine unit of a velocity [length unit/s of machine time]
  double acceleration_unit = 1;  ///< of an acceleration [length unit/s² of machine time]
};

/// Velocities and accelerations of all points, as circuits of their own, after the positions.
///
/// The conditions g = Σ w·a·b + r of a group hold at every moment, so their derivatives vanish too,
///
///     ġ = Σ w (ȧ b + a ḃ) + ṙ = 0,      g̈ = Σ w (ä b + 2 ȧ ḃ + a b̈) + r̈ = 0,
///
/// linear in the unknown velocities v and accelerations with the same matrix J = ∂g/∂x: ġ = J v + c. A servo
/// amplifier for each unknown is fed with Jᵀ ġ: τ v̇ = −v − μ Jᵀ (J v + c). Since Jᵀ J has no negative
/// eigenvalue that is stable in every assembly mode, for groups of any class and however the positions are
/// tracked; two amplifiers on a dyad's two equations would be so only with signs that follow the mode. What a
/// differentiating amplifier would make of the loops' noise does not arise.
RateCircuits add_rates(Circuit& circuit);

}  // namespace oblique::patch
