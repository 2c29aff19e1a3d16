// SPDX-License-Identifier: MIT
#include <oblique/diagram/edit/written_names.h>

namespace oblique::diagram {

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::vector<std::pair<std::size_t, std::string>> written_names(const std::string& text) {
  std::vector<std::pair<std::size_t, std::string>> names;
  for (std::size_t at = 0; at < text.size();) {
    if (!is_name_character(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && (is_name_character(text[end]) || text[end] == '.')) ++end;
    const bool is_number = text[at] >= '0' && text[at] <= '9';
    const std::size_t next = text.find_first_not_of(' ', end);
    const bool is_function = next != std::string::npos && text[next] == '(';
    if (!is_number && !is_function) names.emplace_back(at, text.substr(at, end - at));
    at = end;
  }
  return names;
}

std::string_view block_of(std::string_view signal) {
  return signal.substr(0, signal.find('.'));
}

std::string with_other_name(const std::string& text, const std::string& block, const std::string& name) {
  std::string result;
  std::size_t copied = 0;
  for (const auto& [at, written] : written_names(text)) {
    if (block_of(written) != block) continue;
    result += text.substr(copied, at - copied) + name;
    copied = at + block.size();
  }
  return result + text.substr(copied);
}

}  // namespace oblique::diagram
