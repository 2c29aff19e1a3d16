// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/gradient.h>
#include <oblique/patch/paper.h>
#include <oblique/patch/patch_error.h>
#include <oblique/patch/patch_options.h>
#include <oblique/patch/range.h>
#include <oblique/patch/triangles.h>

namespace oblique::patch {

/// By the method of the options, of the mechanism within its range. Throws PatchError for a period where a
/// drive has a law of its own.
diagram::Diagram patch(const mechanism::Mechanism& mechanism, const PatchOptions& options = {});

}  // namespace oblique::patch
