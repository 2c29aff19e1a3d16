// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

// Not installed.
namespace oblique::text {

/// A string as TOML writes it, in quotes.
std::string toml_string(std::string_view text);

/// A key of TOML: bare where it may be.
std::string toml_key(std::string_view key);

/// What a person writes as a value ("1e5", "10 Hz", "[1, 2]"; not empty), as TOML has it.
std::string toml_value(const std::string& value);

/// Where the quoted text that begins at `begin` ends (one past its quotes), or the end of an unfinished one.
std::size_t end_of_string(std::string_view text, std::size_t begin);

}  // namespace oblique::text
