// SPDX-License-Identifier: MIT
#include <oblique/text/nearest_decimal.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace oblique::text {
namespace {

// The C library's own way there and back; this program never leaves the C locale.
TEST(NearestDecimal, IsWhatPrintingAndReadingGives) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int k = 0; k < 2000; ++k) {
    const double value = (k % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random));
    for (const int digits : {1, 10, 14, 17})
      EXPECT_EQ(nearest_decimal(value, digits),
                std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr));
  }
  EXPECT_EQ(nearest_decimal(0, 14), 0);
  EXPECT_EQ(nearest_decimal(0.1 + 0.2, 14), 0.3);
  const double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(nearest_decimal(largest, 3), largest) << "what cannot be rounded stays";
}

}  // namespace
}  // namespace oblique::text
