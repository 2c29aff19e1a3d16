// SPDX-License-Identifier: MIT
#include <oblique/text/decimal.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

namespace oblique::text {
namespace {

/// What is left to be read.
class Scanner {
 public:
  Scanner(const char* begin, const char* end) : at_(begin), end_(end) {}

  const char* at() const { return at_; }
  bool take(char wanted) {
    if (at_ == end_ || lower(*at_) != wanted) return false;
    ++at_;
    return true;
  }
  /// The whole word or nothing of it.
  bool take(std::string_view word) {
    const char* const from = at_;
    const bool all = std::all_of(word.begin(), word.end(), [&](char c) { return take(c); });
    if (!all) at_ = from;
    return all;
  }
  bool take_digits() {
    const char* const from = at_;
    while (at_ != end_ && is_digit(*at_)) ++at_;
    return at_ != from;
  }
  /// "(…)" of letters, digits and low lines.
  void take_payload() {
    const char* const from = at_;
    if (!take('(')) return;
    while (at_ != end_ && (is_digit(*at_) || (lower(*at_) >= 'a' && lower(*at_) <= 'z') || *at_ == '_'))
      ++at_;
    if (!take(')')) at_ = from;
  }
  void take_exponent() {
    const char* const from = at_;
    if (!take('e')) return;
    if (!take('-')) take('+');
    if (!take_digits()) at_ = from;
  }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

  const char* at_;
  const char* end_;
};

}  // namespace

std::from_chars_result read_decimal_by_strtod(const char* begin, const char* end, double& value) {
  Scanner scanner(begin, end);
  const double sign = scanner.take('-') ? -1 : 1;
  if (scanner.take("inf")) {
    scanner.take("inity");
    value = sign * std::numeric_limits<double>::infinity();
    return {scanner.at(), {}};
  }
  if (scanner.take("nan")) {
    scanner.take_payload();
    value = std::copysign(std::numeric_limits<double>::quiet_NaN(), sign);
    return {scanner.at(), {}};
  }
  const bool whole = scanner.take_digits();
  bool digits = whole;
  if (scanner.take('.')) digits = scanner.take_digits() || whole;
  if (!digits) return {begin, std::errc::invalid_argument};
  const char* const mantissa_end = scanner.at();
  scanner.take_exponent();

  const double read = std::strtod(std::string(begin, scanner.at()).c_str(), nullptr);
  const bool vanished =
      read == 0 && std::any_of(begin, mantissa_end, [](char c) { return c >= '1' && c <= '9'; });
  if (std::isinf(read) || vanished) return {scanner.at(), std::errc::result_out_of_range};
  value = read;
  return {scanner.at(), {}};
}

std::from_chars_result read_decimal(const char* begin, const char* end, double& value) {
#if defined(__cpp_lib_to_chars)
  return std::from_chars(begin, end, value);
#else
  return read_decimal_by_strtod(begin, end, value);
#endif
}

}  // namespace oblique::text
