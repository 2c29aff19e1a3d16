// SPDX-License-Identifier: MIT
#include <oblique/text/nearest_decimal.h>

#include <array>
#include <charconv>

namespace oblique::text {

double nearest_decimal(double value, int digits) {
  std::array<char, 32> text{};  // a sign, 17 digits, a point and an exponent
  char* const begin = text.data();
  const char* const end =
      std::to_chars(begin, begin + text.size(), value, std::chars_format::scientific, digits - 1).ptr;
  double rounded = value;
  std::from_chars(begin, end, rounded);
  return rounded;
}

}  // namespace oblique::text
