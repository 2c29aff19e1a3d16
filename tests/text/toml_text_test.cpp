// SPDX-License-Identifier: MIT
#include <oblique/text/toml_text.h>

#include <gtest/gtest.h>

#include <oblique/text/document.h>

namespace oblique::text {
namespace {

TEST(TomlText, ReadsBackAsItWas) {
  for (const std::string text :
       {"", "plain", "\"quoted\" \\ back", "two\nlines\t\x01\x7f", "φ̇ [°]", "c.gain"}) {
    const Document document = parse_document(toml_key(text) + " = " + toml_string(text), "x");
    ASSERT_EQ(document.root.entries.size(), 1U) << text;
    EXPECT_EQ(document.root.entries[0].key, text);
    EXPECT_EQ(document.root.entries[0].value.text, text);
  }
}

TEST(TomlText, LeavesBareKeysBare) {
  EXPECT_EQ(toml_key("c-1_x"), "c-1_x");
  EXPECT_EQ(toml_key("c.gain"), "\"c.gain\"");
  EXPECT_EQ(toml_key(""), "\"\"");
}

}  // namespace
}  // namespace oblique::text
