// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/patch/patch_options.h>

#include "studio/engine/options.h"

namespace oblique::studio {

/// What may be asked of a patch: "gain", "bandwidth", "slower", "period" (quantities as texts or numbers),
/// "method", "split" [names]. Throws ReadError.
patch::PatchOptions patch_options(const Options& asked);

}  // namespace oblique::studio
