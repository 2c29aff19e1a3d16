// SPDX-License-Identifier: MIT
#include <oblique/report/page_text.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include <oblique/draw/chart/chart.h>

namespace oblique::report {

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
