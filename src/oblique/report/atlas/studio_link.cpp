// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/studio_link.h>

#include <algorithm>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace oblique::report {
namespace {

/// The most that a stored block holds.
constexpr std::size_t kMostStored = 65535;

std::string stored(const std::string& bytes) {
  std::string out;
  std::size_t at = 0;
  do {
    const std::size_t length = std::min(bytes.size() - at, kMostStored);
    const bool last = at + length == bytes.size();
    out += last ? '\1' : '\0';
    for (const std::size_t word : {length, ~length}) {
      out += static_cast<char>(word & 0xFFU);
      out += static_cast<char>((word >> 8U) & 0xFFU);
    }
    out += bytes.substr(at, length);
    at += length;
  } while (at < bytes.size());
  return out;
}

std::string base64url(const std::string& bytes) {
  constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  std::string out;
  std::uint32_t bits = 0;
  int n = 0;
  for (const char c : bytes) {
    bits = (bits << 8U) | static_cast<unsigned char>(c);
    for (n += 8; n >= 6; n -= 6) out += kLetters[(bits >> static_cast<unsigned>(n - 6)) & 0x3FU];
  }
  if (n > 0) out += kLetters[(bits << static_cast<unsigned>(6 - n)) & 0x3FU];
  return out;
}

}  // namespace

std::string studio_fragment(const std::string& name, const std::string& text) {
  const nlohmann::ordered_json file{{"name", name}, {"text", text}};
  return "#" + base64url(stored(file.dump()));
}

}  // namespace oblique::report
