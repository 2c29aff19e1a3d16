// SPDX-License-Identifier: MIT
// One stage alone, without those after it.
#include <cmath>

#include <oblique/text/expression_parser.h>

int main() {
  const double value = oblique::text::evaluate(oblique::text::parse_expression("2*cos(pi/3)"));
  return std::abs(value - 1) < 1e-15 ? 0 : 1;
}
