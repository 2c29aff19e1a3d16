// SPDX-License-Identifier: MIT
#include <oblique/text/encoding.h>

#include <gtest/gtest.h>

namespace oblique::text {
namespace {

// The bounds of table 3-7 of the Unicode standard.
TEST(Encoding, KnowsUtf8) {
  for (const char* const good : {"", "a", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF",
                                 "\xEE\x80\x80", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_TRUE(is_utf8(good)) << good;
  for (const char* const bad :
       {"\x80", "\xC1\xBF", "\xC2", "\xC2\x41", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xE2\x88",
        "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "a\xFF"})
    EXPECT_FALSE(is_utf8(bad)) << bad;
}

TEST(Encoding, ReadsLatin1) {
  EXPECT_EQ(utf8_of_latin1("20\xB0\xFF"), "20°ÿ");
}

TEST(Encoding, ShowsControlCharactersAndObeysNone) {
  EXPECT_EQ(visible("\x1b[2J\a\r"), "␛[2J␇␍");
  EXPECT_EQ(visible(std::string_view("a\0b\x7f", 4)), "a␀b␡");
  EXPECT_EQ(visible("\u0085\u009b31m"), "\uFFFD\uFFFD31m");
  const std::string plain = "φ̇ = 1.5\t[rad/s]\n\u00a0\xff";
  EXPECT_EQ(visible(plain), plain);
  EXPECT_TRUE(is_visible(plain));
  EXPECT_FALSE(is_visible("\u009f"));
  EXPECT_FALSE(is_visible("a\x1b"));
}

}  // namespace
}  // namespace oblique::text
