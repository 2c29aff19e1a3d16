// SPDX-License-Identifier: MIT
#include <oblique/text/decimal.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

namespace oblique::text {
namespace {

/// What a reader makes of a text: how far it reads, how that ended, and the bits of the value.
template <class Read>
std::tuple<std::ptrdiff_t, std::errc, std::uint64_t> outcome(Read read, const std::string& text) {
  double value = 42;
  const char* const begin = text.data();
  const std::from_chars_result result = read(begin, begin + text.size(), value);
  if (std::isnan(value)) value = std::copysign(std::nan(""), value);
  return {result.ptr - begin, result.ec, std::bit_cast<std::uint64_t>(value)};
}

void expect_the_same(const std::string& text) {
  const auto by_library = outcome(
      [](const char* begin, const char* end, double& value) { return std::from_chars(begin, end, value); },
      text);
  EXPECT_EQ(outcome(read_decimal, text), by_library) << text;
  EXPECT_EQ(outcome(read_decimal_by_strtod, text), by_library) << text;
}

// The oracle is the standard library that has the function; this program never leaves the C locale.
TEST(Decimal, IsReadAsTheStandardLibraryReadsIt) {
  for (const char* const text : {"",
                                 "-",
                                 ".",
                                 "-.",
                                 "+1",
                                 " 1",
                                 "1",
                                 "-0",
                                 "007",
                                 "5.",
                                 ".5",
                                 "5.e3",
                                 "-.5e-3",
                                 "1e",
                                 "1e+",
                                 "1e-x",
                                 "1E5",
                                 "1.5e+03kg",
                                 "0x1p3",
                                 "1,5",
                                 "1..2",
                                 "--1",
                                 "1e999",
                                 "-1e999",
                                 "1e-999",
                                 "0e999",
                                 "2e-324",
                                 "4.9e-324",
                                 "1e-310",
                                 "1.7976931348623157e308",
                                 "1.7976931348623159e308",
                                 "2.2250738585072011e-308",
                                 "inf",
                                 "-INF",
                                 "Infinity",
                                 "infin",
                                 "nan",
                                 "-NaN",
                                 "NAN",
                                 "nan(A)",
                                 "nan(ab_1)",
                                 "nan(a",
                                 "nan()",
                                 "in",
                                 "n",
                                 "9007199254740993",
                                 "0.1",
                                 "123456789012345678901234567890"})
    expect_the_same(text);
}

TEST(Decimal, IsReadAsTheStandardLibraryReadsItWhateverItIs) {
  std::mt19937_64 random(5);
  const std::string letters = "0123456789.eE+-infa( )";
  for (int k = 0; k < 20'000; ++k) {
    std::string text;
    for (std::uint64_t n = random() % 24; n > 0; --n) text += letters[random() % letters.size()];
    expect_the_same(text);
  }
}

// Values of all magnitudes with as many digits as tell them apart, and more.
TEST(Decimal, IsTheNearestNumber) {
  std::mt19937_64 random(6);
  for (int k = 0; k < 20'000; ++k) {
    const auto value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    std::array<char, 64> text{};
    const int length = std::snprintf(text.data(), text.size(), "%.*e", k % 2 == 0 ? 16 : 25, value);
    double read = 0;
    EXPECT_EQ(read_decimal_by_strtod(text.data(), text.data() + length, read).ec, std::errc{});
    EXPECT_EQ(read, value);
    expect_the_same(std::string(text.data(), static_cast<std::size_t>(length)));
  }
}

}  // namespace
}  // namespace oblique::text
