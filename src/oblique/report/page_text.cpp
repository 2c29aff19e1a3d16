// SPDX-License-Identifier: MIT
#include <oblique/report/page_text.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include <oblique/draw/chart/chart.h>

namespace oblique::report {
namespace {

/// One letter, of whatever alphabet, and what may stand at its foot: "φ", "x1".
bool is_symbol(std::string_view name) {
  std::size_t end = 1;
  while (end < name.size() && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) ++end;
  return name.find_first_not_of("0123456789", end) == std::string_view::npos;
}

}  // namespace

std::string readable(double value) {
  const double size = std::abs(value);
  const char* const sign = value < 0 ? "−" : "";
  if (size == 0 || (size >= 1e-3 && size < 9999)) return sign + fmt::format("{:.4g}", size);
  if (size >= 9999 && size < 1e5) return sign + fmt::format("{:.0f}", size);
  if (!std::isfinite(value)) return std::isnan(value) ? "unknown" : sign + std::string("∞");
  auto exponent = static_cast<int>(std::floor(std::log10(size)));
  std::string digits = fmt::format("{:.4g}", size / std::pow(10, exponent));
  if (digits == "10") digits = "1", ++exponent;  // rounded up
  return digits == "1" ? sign + draw::power_of_ten(exponent)
                       : sign + digits + "·" + draw::power_of_ten(exponent);
}

std::string printed_expression(const std::string& expression) {
  std::string text;
  for (std::size_t k = 0; k < expression.size(); ++k) {
    const char c = expression[k];
    const bool follows_digit = k > 0 && std::isdigit(static_cast<unsigned char>(expression[k - 1])) != 0;
    if (c == 'e' && follows_digit && k + 2 < expression.size() &&
        (expression[k + 1] == '+' || expression[k + 1] == '-')) {
      std::size_t end = k + 2;
      while (end < expression.size() && std::isdigit(static_cast<unsigned char>(expression[end])) != 0) ++end;
      text += "·" + draw::power_of_ten(std::stoi(expression.substr(k + 1, end - k - 1)));
      k = end - 1;
    } else if (c == '*') {
      text += "·";
    } else if (c == '-') {
      text += "−";
    } else {
      text += c;
    }
  }
  return text;
}

std::string derivative_of(const std::string& name) {
  return is_symbol(name) ? fmt::format("d{}/dt", name) : fmt::format("d({})/dt", name);
}

std::string words_of(const text::Error& error, const text::Vocabulary& vocabulary) {
  const text::Diagnostic& finding = error.diagnostics().front();
  std::string text = finding.what;
  if (!finding.expected.empty()) text += "; expected " + finding.expected;
  if (!finding.remedy.empty()) text += ". Remedy: " + finding.remedy.words(vocabulary);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text + ".";
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace oblique::report
