// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::mechanism {

/// Reads an oblique-mechanism/1 text; `file` is the name that messages give. Everything that is wrong with
/// the file is reported together. Whether it can move and be assembled is not asked here: see `decompose`.
/// Throws ReadError (broken TOML) and MechanismError (kind `file`).
Mechanism parse_mechanism(std::string_view text, std::string file);

/// Reads a file; throws as `parse_mechanism`, and ReadError where the file cannot be opened.
Mechanism read_mechanism(const std::filesystem::path& path);

}  // namespace oblique::mechanism
