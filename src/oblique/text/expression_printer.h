// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/text/expression.h>

namespace oblique::text {

/// Prints with as few parentheses as the grammar needs; `parse_expression` reads it back unchanged (an
/// infinite number as the name `inf`; not-a-number has no text).
std::string to_string(const Expression& expression);

}  // namespace oblique::text
