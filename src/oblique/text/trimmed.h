// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace oblique::text {

/// Without the blanks, the ends of lines and the end of a DOS file around it. Not installed.
constexpr std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\x1a";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

inline std::string trimmed(const std::string& text) {
  return std::string(trimmed(std::string_view(text)));
}

}  // namespace oblique::text
