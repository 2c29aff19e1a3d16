// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studio/engine/answer.h"

namespace oblique::studio {

/// The options of a call, read one by one. All throw ReadError for what is not of the kind.
class Options {
 public:
  /// A JSON object with no other keys than these, or an empty text for none.
  Options(const std::string& text, std::initializer_list<std::string_view> known);

  bool flag(const char* key) const;
  std::optional<std::string> word(const char* key) const;
  std::vector<std::string> words(const char* key) const;
  /// A number, or a quantity as text ("20 ms"), in `unit`; finite.
  std::optional<double> quantity(const char* key, std::string_view unit) const;
  /// A whole number from `least` to `most`.
  std::optional<int> whole(const char* key, int least, int most) const;
  /// {"c.gain": "1e4"}: names and texts.
  std::vector<std::pair<std::string, std::string>> settings(const char* key) const;

 private:
  const Json* find(const char* key) const;
  Json json_;
};

}  // namespace oblique::studio
