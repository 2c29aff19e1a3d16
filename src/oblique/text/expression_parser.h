// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

#include <oblique/text/expression.h>

namespace oblique::text {

/// Parses a whole text. Grammar, loosest first: `or`, `and`, `not`, comparisons (which do not chain), `+ -`,
/// `* /`, unary `-`, `^` (right associative), calls, names, numbers, parentheses. A minus before a lone
/// number makes a negative number. At most 200 levels and 1000 operators. Throws ExpressionError.
Expression parse_expression(std::string_view text);

/// Parses the longest expression at the front of `text` and sets `rest` to where it ends (for "30 deg").
Expression parse_expression_prefix(std::string_view text, std::size_t& rest);

}  // namespace oblique::text
