// SPDX-License-Identifier: MIT
#include "studio/engine/options.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/text/quantity.h>

namespace oblique::studio {
namespace {

[[noreturn]] void refuse_value(std::string_view key, const Json& value, std::string expected) {
  throw text::ReadError(
      text::Diagnostic{{}, fmt::format("'{}' is {}", key, to_text(value)), std::move(expected), {}});
}

}  // namespace

Options::Options(const std::string& text, std::initializer_list<std::string_view> known) {
  json_ = text.empty() ? Json::object() : Json::parse(text, nullptr, false);
  if (!json_.is_object())
    throw text::ReadError(text::Diagnostic{{}, "the options are no JSON object", R"({"until": 2})", {}});
  for (const auto& [key, value] : json_.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw text::ReadError(
        text::Diagnostic{{},
                         fmt::format("there is no option '{}'", key),
                         {},
                         text::suggest(key, std::vector<std::string>(known.begin(), known.end()))});
  }
}

const Json* Options::find(const char* key) const {
  const auto found = json_.find(key);
  return found == json_.end() || found->is_null() ? nullptr : &*found;
}

bool Options::flag(const char* key) const {
  const Json* const value = find(key);
  if (value == nullptr) return false;
  if (!value->is_boolean()) refuse_value(key, *value, "true or false");
  return value->get<bool>();
}

std::optional<std::string> Options::word(const char* key) const {
  const Json* const value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_string()) refuse_value(key, *value, "a text");
  return value->get<std::string>();
}

std::vector<std::string> Options::words(const char* key) const {
  std::vector<std::string> all;
  const Json* const value = find(key);
  if (value == nullptr) return all;
  if (!value->is_array()) refuse_value(key, *value, "a list of texts");
  for (const Json& one : *value) {
    if (!one.is_string()) refuse_value(key, *value, "a list of texts");
    all.push_back(one.get<std::string>());
  }
  return all;
}

std::optional<double> Options::quantity(const char* key, std::string_view unit) const {
  const Json* const value = find(key);
  if (value == nullptr) return std::nullopt;
  if (value->is_number()) return value->get<double>();
  if (!value->is_string()) refuse_value(key, *value, "a number or a quantity as text");
  const auto text = value->get<std::string>();
  try {
    return text::parse_quantity(text, text::parse_unit(unit).value());
  } catch (const text::ExpressionError& error) {
    throw text::ReadError(text::Diagnostic{
        {}, fmt::format("'{}' is {}: {}", key, text, error.what), error.expected, error.remedy});
  }
}

std::optional<int> Options::whole(const char* key, int least, int most) const {
  const Json* const value = find(key);
  if (value == nullptr) return std::nullopt;
  const double number = value->is_number() ? value->get<double>() : std::nan("");
  if (!(number >= least && number <= most && number == std::floor(number)))
    refuse_value(key, *value, fmt::format("a whole number from {} to {}", least, most));
  return static_cast<int>(number);
}

std::vector<std::pair<std::string, std::string>> Options::settings(const char* key) const {
  std::vector<std::pair<std::string, std::string>> all;
  const Json* const value = find(key);
  if (value == nullptr) return all;
  if (!value->is_object()) refuse_value(key, *value, R"(an object such as {"c.gain": "1e4"})");
  for (const auto& [name, setting] : value->items()) {
    if (!setting.is_string() && !setting.is_number()) refuse_value(key, *value, "texts or numbers");
    all.emplace_back(name, setting.is_string() ? setting.get<std::string>() : to_text(setting));
  }
  return all;
}

}  // namespace oblique::studio
