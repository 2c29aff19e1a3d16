// SPDX-License-Identifier: MIT
#include <oblique/text/nearest_decimal.h>

#include <array>

#include <fmt/format.h>

#include <oblique/text/decimal.h>

namespace oblique::text {

double nearest_decimal(double value, int digits) {
  std::array<char, 32> text{};  // a sign, 17 digits, a point and an exponent
  char* const begin = text.data();
  const char* const end = fmt::format_to_n(begin, text.size(), "{:.{}e}", value, digits - 1).out;
  double rounded = value;
  read_decimal(begin, end, rounded);
  return rounded;
}

}  // namespace oblique::text
