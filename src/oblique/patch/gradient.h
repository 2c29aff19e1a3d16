// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch_options.h>

namespace oblique::patch {

/// The diagram that simulates any mechanism by the gradient servo: with the unknown coordinates x of the
/// points that a group places and its conditions g = 0 [length],
///
///     ẋ = −K Σ g ∂g/∂x,      K = gain · 2π · bandwidth
///
/// which is stable in every assembly mode, since Σ g² can only fall; its price is a lag of about |ẋ|/(K σ²),
/// σ the least singular value of ∂g/∂x. Multipliers, summers and integrators alone. Scaled, and throws, as
/// `patch_triangles`; and a PatchError of kind `request` for an infinite gain or bandwidth.
diagram::Diagram patch_gradient(const mechanism::Mechanism& mechanism, const PatchOptions& options = {});

}  // namespace oblique::patch
