// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

// Not installed.
namespace oblique::text {

/// A string as TOML writes it, in quotes.
std::string toml_string(std::string_view text);

/// A key of TOML: bare where it may be.
std::string toml_key(std::string_view key);

}  // namespace oblique::text
