// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace oblique::text {

/// Reads a file whole. Throws ReadError where it cannot be opened.
std::string read_file(const std::filesystem::path& path);

/// Writes a file whole or not at all. Throws ReadError where that fails; the old file is then untouched.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Throws ReadError that names the endings (".csv" …; at least one) where the path has none of them.
void check_ending(const std::filesystem::path& path, std::span<const std::string_view> endings);

}  // namespace oblique::text
