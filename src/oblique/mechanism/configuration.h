// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/mechanism.h>
#include <oblique/mechanism/structure.h>

namespace oblique {

/// How the mechanism stands.
enum class Status {
  ok,
  dead_centre,  ///< a dyad's triangle is flat to rounding: positions are good, rates of the group have no
                ///< value
  open,         ///< a dyad cannot be assembled: no numbers
};

/// "ok", "dead-centre", "open".
std::string_view status_name(Status status);

/// Position, velocity and acceleration of a point [length unit, s].
struct PointState {
  Eigen::Vector2d position;
  Eigen::Vector2d velocity;
  Eigen::Vector2d acceleration;
};

/// Angle of a body's first → second point from +x [rad], and its rates [rad/s], [rad/s²].
struct BodyState {
  double angle;
  double omega;
  double alpha;
};

/// All points and bodies of a mechanism at one moment, indexed as in Mechanism. What has no value is NaN.
struct Configuration {
  std::vector<PointState> points;
  std::vector<BodyState> bodies;
  Status status = Status::ok;
  std::optional<std::size_t> group;  ///< the first group that is not `ok`, index in Structure::groups
};

/// Exact configuration at given drive angles [rad], one for each of Mechanism::drives; rates belong to the
/// drives' constant speeds. Driven bodies have exactly the drive's angle, the others one in (−π, π].
///
/// A crank is a rotation. In a dyad, with d = Q − P, e₁ = C − P, e₂ = C − Q and D = e₁ × e₂ = ± 2·area of
/// PQC,
///
///     C = P + (along·d + side·height·d⊥)/L          from the triangle's three sides
///     ω₁ = e₂·(Q̇ − Ṗ)/D,   ω₂ = e₁·(Q̇ − Ṗ)/D       derivatives of |e₁| = r₁, |e₂| = r₂
///     α₁ = e₂·b/D,   α₂ = e₁·b/D,   b = Q̈ − P̈ + ω₁²e₁ − ω₂²e₂
///
/// (the loop equations and their two derivatives in closed form; no tangents, no slopes).
Configuration solve_configuration(const Mechanism& mechanism, const Structure& structure,
                                  std::span<const double> drive_angles);

/// The drives' angles at time `t` [s]: start + speed·t [rad].
std::vector<double> drive_angles(const Mechanism& mechanism, double t);

/// The parts of `solve_configuration`: places one group whose known points stand in `configuration` already.
/// A dyad that does not reach leaves its points NaN and gives `open`.
Configuration frame_configuration(const Mechanism& mechanism);
Status place_crank(const Mechanism& mechanism, const CrankGroup& crank, double angle,
                   Configuration& configuration);
Status place_dyad(const Mechanism& mechanism, const DyadGroup& dyad, Configuration& configuration);

}  // namespace oblique
