// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/patch/patch.h>

#include "command.h"

namespace oblique::cli {

/// A finite number above 0 given as an option, in `unit`. Throws ReadError that names the option.
double positive_option(const std::string& option, const std::string& text, std::string_view unit);

/// The patch that --method, --gain and --bandwidth ask for. Throws ReadError.
PatchOptions patch_options(const PatchChoice& choice);

}  // namespace oblique::cli
