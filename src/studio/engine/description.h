// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/diagram/block_library.h>

#include "studio/engine/answer.h"

namespace oblique::studio {

/// What a file holds. A diagram: {"kind", "title", "until", "machine", "blocks": [{"name", "type"}],
/// "outputs":
/// [{"name", "unit"}], "signals", "lesson"}; a mechanism: {"kind", "title", "unit", "points", "bodies",
/// "drives": [{"name", "slide"}], "groups": [{"name", "class"}]}. Throws ReadError for what is neither.
Json description_of(const std::string& text, const std::string& name, const diagram::BlockLibrary& library);

}  // namespace oblique::studio
