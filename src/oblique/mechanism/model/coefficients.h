// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// Columns that an analysis adds to those of a motion:
///
/// * kinematic coefficients (analogues of velocity and acceleration; Ihnatyshyn et al.), the
///   derivatives by the first drive's value s instead of time, x' = ẋ/ṡ and x″ = (ẍ − x' s̈)/ṡ²:
///   `P.dx P.ddx P.dy P.ddy` of every moving point, `b.dangle b.ddangle` of every body, `s.dposition
///   s.ddposition` of every prismatic joint; without a value where the drive stands still;
/// * `b.icx b.icy`, the instant centre of every body against the frame; without a value at infinity;
/// * `GROUP.transmission` or `GROUP.pressure` [rad] of every RRR and RRP dyad (Transmission);
/// * with masses, `DRIVE.inertia` [kg m²] or [kg] and `DRIVE.energy` [J] (reduced_inertia, kinetic_energy).
std::vector<MotionColumn> analysis_columns(const Mechanism& mechanism, const Structure& structure,
                                           const Motion& motion);

/// x' and x″ from the rates of x and the drive.
struct Coefficients {
  double first = 0, second = 0;
};
Coefficients kinematic_coefficients(double rate, double acceleration, const DriveState& drive);

}  // namespace oblique::mechanism
