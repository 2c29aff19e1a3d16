// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <oblique/diagram/diagram.h>

namespace oblique::diagram {

/// Reads a diagram's text. Throws DiagramError with all findings of this one file (wiring is checked by
/// `flatten`), ReadError for broken TOML.
Diagram parse_diagram(std::string_view text, std::string file);
Diagram read_diagram(const std::filesystem::path& path);

}  // namespace oblique::diagram
