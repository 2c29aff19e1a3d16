// SPDX-License-Identifier: MIT
#include <oblique/synthesis/text_edit.h>

#include <algorithm>

namespace oblique::synthesis {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Positions count characters, each of which may be several bytes of UTF-8.
std::size_t byte_of(std::string_view text, text::SourcePosition position) {
  std::size_t at = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (int line = 1; line < position.line; ++line) at = text.find('\n', at) + 1;
  const auto goes_on = [&] {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  for (int column = 1; column < position.column; ++column) {
    ++at;
    while (goes_on()) ++at;
  }
  return at;
}

bool is_utf8(std::string_view text) {
  try {
    text::parse_document("# " + std::string(text) + "\n", {});
  } catch (const text::ReadError&) {
    return false;
  }
  return true;
}

}  // namespace

TextRange range_of(std::string_view text, const text::Value& value) {
  const std::size_t begin = byte_of(text, value.position);
  if (value.kind != text::Value::Kind::string) {
    return {begin, std::min(text.find_first_of(",]}# \t\r\n", begin), text.size())};
  }
  const std::string_view quote =
      text.substr(begin, text.substr(begin + 1, 2) == text.substr(begin, 2) ? 3 : 1);
  // a quantity holds no quotes, and so no escaped ones
  return {begin, text.find(quote, begin + quote.size()) + quote.size()};
}

std::string replace_ranges(std::string_view text, std::vector<Replacement> replacements) {
  std::sort(replacements.begin(), replacements.end(),
            [](const Replacement& a, const Replacement& b) { return a.range.begin < b.range.begin; });
  std::string result;
  std::size_t at = 0;
  for (const Replacement& replacement : replacements) {
    result += text.substr(at, replacement.range.begin - at);
    result += replacement.text;
    at = replacement.range.end;
  }
  return result += text.substr(at);
}

std::string with_comment(std::string_view text, std::string comment) {
  const auto replace_if = [&](auto&& bad) { std::replace_if(comment.begin(), comment.end(), bad, '?'); };
  replace_if([](char c) { return (c >= 0 && c < ' ') || c == 127; });
  if (!is_utf8(comment)) replace_if([](char c) { return (static_cast<unsigned char>(c) & 0x80U) != 0; });
  const std::size_t begin = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  const std::size_t line_end = text.find('\n');
  const bool carriage_return =
      line_end != std::string_view::npos && line_end > 0 && text[line_end - 1] == '\r';
  std::string result(text.substr(0, begin));
  result += "# " + comment + (carriage_return ? "\r\n" : "\n");
  return result += text.substr(begin);
}

}  // namespace oblique::synthesis
