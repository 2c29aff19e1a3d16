// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/text/expression.h>

namespace oblique {

/// The derivative by `time` of a speed law, as an expression: of any that `parse_law` takes. What is zero or
/// one is left out.
Expression law_derivative(const Expression& law);

}  // namespace oblique
