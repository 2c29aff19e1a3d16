// SPDX-License-Identifier: MIT
#include <oblique/report/json_text.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace oblique::report {
namespace {

TEST(JsonText, IndentsAndKeepsTheOrder) {
  nlohmann::ordered_json json;
  json["z"] = {1, "φ"};
  json["a"] = nullptr;
  EXPECT_EQ(json_text(json), "{\n  \"z\": [\n    1,\n    \"φ\"\n  ],\n  \"a\": null\n}\n");
}

TEST(JsonText, IsUtf8WhateverANameIs) {
  const nlohmann::ordered_json json = "a\xFF.toml";  // Linux takes any byte but '/' and NUL in a name
  EXPECT_EQ(json_text(json), "\"a\uFFFD.toml\"\n");
}

}  // namespace
}  // namespace oblique::report
