// SPDX-License-Identifier: MIT
#include <oblique/text/decimal_comma.h>

#include <oblique/text/expression_grammar.h>

namespace oblique::text {

bool is_decimal_comma(std::string_view text, std::size_t at) {
  return at + 1 < text.size() && text[at] == ',' && is_digit(text[at + 1]);
}

ExpressionError decimal_comma(std::string_view text, std::size_t at) {
  std::string point(text);
  int depth = 0;
  for (std::size_t k = 0; k < point.size(); ++k) {
    if (point[k] == '(') ++depth;
    if (point[k] == ')') --depth;
    if (depth == 0 && is_decimal_comma(text, k)) point[k] = '.';
  }
  return {static_cast<int>(at) + 1, "there is a comma in the number", "a decimal point", "write " + point};
}

}  // namespace oblique::text
