// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace oblique {

/// The text behind its byte order mark, where it has one. Throws ReadError for a text in UTF-16; `file` is
/// the name that the message gives.
std::string_view without_byte_order_mark(std::string_view text, const std::string& file);

/// Whether a text is well-formed UTF-8.
bool is_utf8(std::string_view text);

/// A text in Latin-1 as UTF-8.
std::string utf8_of_latin1(std::string_view text);

}  // namespace oblique
