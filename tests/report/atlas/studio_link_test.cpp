// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/studio_link.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace oblique::report {
namespace {

/// Base64url without padding, after RFC 4648.
std::string decoded(const std::string& letters) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  std::string bytes;
  unsigned bits = 0, n = 0;
  for (const char c : letters) {
    bits = bits << 6U | static_cast<unsigned>(alphabet.find(c));
    n += 6;
    if (n < 8) continue;
    n -= 8;
    bytes += static_cast<char>(bits >> n & 0xFFU);
  }
  return bytes;
}

/// The stored blocks of a deflate stream, after RFC 1951, section 3.2.4.
std::string inflated(const std::string& stream, int& blocks) {
  std::string text;
  std::size_t at = 0;
  for (bool last = false; !last; ++blocks) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(stream.at(at + k)); };
    last = (byte(0) & 1U) != 0;
    EXPECT_EQ(byte(0) >> 1U, 0U);  // stored
    const unsigned length = byte(1) | byte(2) << 8U;
    EXPECT_EQ(length ^ (byte(3) | byte(4) << 8U), 0xFFFFU);
    text += stream.substr(at + 5, length);
    at += 5 + length;
  }
  EXPECT_EQ(at, stream.size());
  return text;
}

TEST(StudioLink, HoldsTheFile) {
  for (const std::size_t size : {0U, 1U, 2U, 3U, 1000U, 65535U, 200000U}) {
    const std::string text = "φ \"" + std::string(size, 'x') + "\"\n";
    const std::string fragment = studio_fragment("a.toml", text);
    ASSERT_EQ(fragment.front(), '#');
    EXPECT_EQ(fragment.find_first_of("+/="), std::string::npos);
    int blocks = 0;
    const auto file = nlohmann::json::parse(inflated(decoded(fragment.substr(1)), blocks));
    EXPECT_EQ(file["name"], "a.toml");
    EXPECT_EQ(file["text"], text);
    EXPECT_EQ(blocks, size < 60000 ? 1 : size < 100000 ? 2 : 4);
  }
}

}  // namespace
}  // namespace oblique::report
