// SPDX-License-Identifier: MIT
#include <oblique/text/encoding.h>

#include <algorithm>
#include <cstddef>

#include <oblique/text/diagnostic.h>

namespace oblique::text {
namespace {

unsigned char byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

/// How many bytes the character beginning at `at` has; 0 where none begins there (RFC 3629, table in 4).
std::size_t character_length(std::string_view text, std::size_t at) {
  const unsigned char first = byte_at(text, at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte_at(text, at + k) & 0xC0) != 0x80) return 0;
  }
  const unsigned char second = byte_at(text, at + 1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool surrogate = first == 0xED && second >= 0xA0;
  const bool beyond = first == 0xF4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text, const std::string& file) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw ReadError(Diagnostic{{file, {1, 1}},
                               "the file is in UTF-16",
                               "text in UTF-8",
                               "save it anew and choose UTF-8 as its encoding"});
  }
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

namespace {

/// How many bytes a control character has that begins at `at`; 0: none does. Those above ASCII are U+0080 to
/// U+009F.
std::size_t control_length(std::string_view text, std::size_t at) {
  const unsigned char c = byte_at(text, at);
  if (c == 0xC2 && at + 1 < text.size() && byte_at(text, at + 1) >= 0x80 && byte_at(text, at + 1) < 0xA0)
    return 2;
  return (c < 0x20 && c != '\n' && c != '\t') || c == 0x7F ? 1 : 0;
}

}  // namespace

bool is_visible(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (control_length(text, at) > 0) return false;
  }
  return true;
}

std::string visible(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = control_length(text, at);
    const unsigned char c = byte_at(text, at);
    if (length == 0) {
      out += text[at];
    } else if (length == 2) {
      out += "\uFFFD";
    } else {  // the pictures stand in their order from U+2400 on, that of DEL behind them
      out += "\xE2\x90";
      out += static_cast<char>(0x80 + (c == 0x7F ? 0x21 : c));
    }
    at += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string utf8_of_latin1(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out += c;
    } else {
      out += static_cast<char>(0xC0 | (byte >> 6));
      out += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return out;
}

}  // namespace oblique::text
