// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/text/expression.h>

namespace oblique::mechanism {

/// The derivative by `time` of a speed law, as an expression: of any that `parse_law` takes. What is zero or
/// one is left out. Throws ExpressionError for `noise` and for what switches.
text::Expression law_derivative(const text::Expression& law);

}  // namespace oblique::mechanism
