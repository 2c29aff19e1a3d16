// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace oblique::text {

/// The text behind its byte order mark, where it has one. Throws ReadError for a text in UTF-16; `file` is
/// the name that the message gives.
std::string_view without_byte_order_mark(std::string_view text, const std::string& file);

/// Whether a text is well-formed UTF-8.
bool is_utf8(std::string_view text);

/// The text without control characters, by which a terminal would do what a file says: each stands as its
/// picture (␛ for ESC, ␀ for NUL) or, where it has none, as �. Lines and tabs stay.
std::string visible(std::string_view text);

/// Whether `visible` leaves the text as it is.
bool is_visible(std::string_view text);

/// A text in Latin-1 as UTF-8.
std::string utf8_of_latin1(std::string_view text);

}  // namespace oblique::text
