// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch_options.h>

namespace oblique::patch {

/// The diagram of the source (AVM class III) for a mechanism of cranks and triads on three links, so that it
/// can be read beside the source: two equal circuits `four-bar-circuit` with one scale for all lengths, an
/// outer loop that tracks the variable length, and the source's angles among the outputs. The split is the
/// source's unless the options name one: the first leg, that hangs on a crank, carries the variable length,
/// the second one in the file closes the loop. Scaled, and throws, as `patch_triangles`.
diagram::Diagram patch_paper(const mechanism::Mechanism& mechanism, const PatchOptions& options = {});

}  // namespace oblique::patch
