// SPDX-License-Identifier: MIT
#include <oblique/report/page_text.h>

#include <limits>

#include <gtest/gtest.h>

namespace oblique::report {
namespace {

TEST(PageText, HasNumbersAsPeopleWriteThem) {
  EXPECT_EQ(readable(0), "0");
  EXPECT_EQ(readable(0.0125), "0.0125");
  EXPECT_EQ(readable(-1234.56), "−1235");
  EXPECT_EQ(readable(12345.6), "12346");
  EXPECT_EQ(readable(-4.444e11), "−4.444·10¹¹");
  EXPECT_EQ(readable(1e-5), "10⁻⁵");
  EXPECT_EQ(readable(9.99999e-5), "10⁻⁴");
  EXPECT_EQ(readable(-std::numeric_limits<double>::infinity()), "−∞");
  EXPECT_EQ(readable(std::numeric_limits<double>::quiet_NaN()), "unknown");
}

TEST(PageText, PrintsExpressionsAsBooksDo) {
  EXPECT_EQ(printed_expression("10*y - 1.5e+08*x"), "10·y − 1.5·10⁸·x");
  EXPECT_EQ(printed_expression("-1e-05"), "−1·10⁻⁵");
  EXPECT_EQ(printed_expression("rate - e"), "rate − e");
}

TEST(PageText, PutsLongNamesOfDerivativesInParentheses) {
  EXPECT_EQ(derivative_of("x"), "dx/dt");
  EXPECT_EQ(derivative_of("φ"), "dφ/dt");
  EXPECT_EQ(derivative_of("x12"), "dx12/dt");
  EXPECT_EQ(derivative_of("xB"), "d(xB)/dt");
  EXPECT_EQ(derivative_of("crank.sine"), "d(crank.sine)/dt");
}

TEST(PageText, TellsAFailureInASentence) {
  const text::Error error(
      text::Diagnostic{{"d.toml", {1, 2}}, "it is 3", "a number\nbelow 2", "count again"});
  EXPECT_EQ(words_of(error, text::plain_vocabulary()),
            "it is 3; expected a number below 2. Remedy: count again.");
  EXPECT_EQ(words_of(text::Error(text::Diagnostic{{}, "no", {}, {}}), text::plain_vocabulary()), "no.");
  EXPECT_EQ(capitalised("it fits"), "It fits");
  EXPECT_EQ(capitalised(""), "");
}

}  // namespace
}  // namespace oblique::report
