// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/diagram/block_library.h>

#include "studio/engine/answer.h"

namespace oblique::studio {

/// {"svg"} of a diagram or a mechanism. Options of both: "theme" ("auto", "light" or "dark"); of a diagram:
/// "symbols"
/// ("classic" or "din"), "depth" (of the composites that are opened), "data"; of a mechanism: "time" [s],
/// "positions". Throws ReadError.
Json drawn(const std::string& text, const std::string& name, const diagram::BlockLibrary& library,
           const std::string& options);

}  // namespace oblique::studio
