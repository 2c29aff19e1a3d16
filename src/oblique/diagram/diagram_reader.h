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
/// The same of a text that may be wrong, as far as it is right: the findings are added to `diagnostics`.
/// Throws for what is no diagram at all, and ReadError.
Diagram parse_diagram(std::string_view text, std::string file, text::Diagnostics& diagnostics);
Diagram read_diagram(const std::filesystem::path& path);

}  // namespace oblique::diagram
