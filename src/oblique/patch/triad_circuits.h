// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/patch/circuit.h>
#include <oblique/patch/triad_split.h>

namespace oblique::patch {

/// A triad on links as two triangles and an outer loop: blocks `dyad-rrr-variable` and `dyad-rrr`, each
/// triangle in a scale of its own.
void add_triad(Circuit& circuit, const mechanism::Group& group, const TriadSplit& split);

/// Gives all points that the group carries their forms, once the platform's points b and d have signals.
void carry_triad(PointBook& places, const mechanism::Group& group, std::size_t b, std::size_t d);

/// Where the loops of a triangle on P, Q with the apex C stand at the start: a group of loops that hang on
/// each other finds its rest from there.
struct TriangleStart {
  double length = 0;                        ///< |PQ| [length unit]
  double cosine = 0, sine = 0;              ///< of the direction of P → Q
  double angle_cosine = 0, angle_sine = 0;  ///< of the angle at P, sine ≥ 0
};
TriangleStart triangle_start(const mechanism::Motion& motion, std::size_t p, std::size_t q, std::size_t c);

/// The points of a split, by the letters of its figure (`TriadSplit`).
struct TriadPoints {
  std::size_t a = 0, b = 0;  ///< of the tracked leg: on what is known, on the platform
  std::size_t z = 0, c = 0;  ///< of the closing leg
  std::size_t e = 0, d = 0;  ///< of the third leg
};
TriadPoints points_of(const mechanism::Group& group, const TriadSplit& split);

/// The servo amplifier named `length` that drives the variable length, from what is summed in `residual`.
void add_outer_loop(Circuit& circuit, const std::string& length, const Terms& residual, double initial);

}  // namespace oblique::patch
