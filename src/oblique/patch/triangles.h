// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch_options.h>

namespace oblique::patch {

/// The diagram that simulates a mechanism by servo-tracked triangles over one turn of its first drive: a
/// crank generator for each drive and a dyad of oblique triangles for each pair of links (method:
/// AVM class III). All signals are scaled by the exact motion to stay within ±1 machine unit;
/// `[outputs]` scale back and carry the names of `solve`'s columns ("C.x"). Throws PatchError where a
/// triangle does not close or becomes collinear on the way, MechanismError as `decompose`.
diagram::Diagram patch_triangles(const mechanism::Mechanism& mechanism, const PatchOptions& options = {});

}  // namespace oblique::patch
