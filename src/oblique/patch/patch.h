// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/mechanism.h>

namespace oblique {

/// Thrown by the `patch` stage: a mechanism that cannot be turned into a diagram.
class PatchError : public Error {
 public:
  using Error::Error;
};

/// How a mechanism is patched.
struct PatchOptions {
  double gain = 1e6;  ///< μ of every servo amplifier; inf: ideal amplifiers
  std::optional<double>
      bandwidth;  ///< of every servo amplifier [Hz]; inf: algebraic loops; default: `default_bandwidth`
  double tolerance = 1e-10;  ///< of the run that the diagram asks for
  int samples = 361;         ///< rows of that run
};

/// A hundred times the frequency of the fastest drive, rounded up to 1, 2 or 5 times a power of ten [Hz]: the
/// pole of the open loop then turns the phase of a signal at crank frequency by half a degree.
double default_bandwidth(const Mechanism& mechanism);

/// The diagram that simulates a mechanism by servo-tracked triangles over one turn of its first drive: a
/// crank generator for each drive and a dyad of oblique triangles for each pair of links (method:
/// 003_69ea068b7b221c3d.txt). All signals are scaled by the exact motion to stay within ±1 machine unit;
/// `[outputs]` scale back and carry the names of `solve`'s columns ("C.x"). Throws PatchError where a
/// triangle does not close or goes flat on the way, MechanismError as `decompose`.
Diagram patch_triangles(const Mechanism& mechanism, const PatchOptions& options = {});

}  // namespace oblique
