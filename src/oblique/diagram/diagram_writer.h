// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>

namespace oblique::diagram {

/// The text of a diagram, one block a line, with its comments; `parse_diagram` gives an equal diagram back.
std::string write_diagram(const Diagram& diagram);

/// The text of a `[layout]` table, after an empty line; nothing where there are no places.
std::string write_layout(const std::vector<BlockPlace>& layout);

}  // namespace oblique::diagram
