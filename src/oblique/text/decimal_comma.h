// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <oblique/text/expression.h>

namespace oblique::text {

/// Whether there is a comma at `at` that begins decimals: a digit follows it.
bool is_decimal_comma(std::string_view text, std::size_t at);

/// What to say of the decimal comma at `at`: that it stands there, and the text with points instead. The
/// commas within parentheses stay, since they may part arguments.
ExpressionError decimal_comma(std::string_view text, std::size_t at);

}  // namespace oblique::text
