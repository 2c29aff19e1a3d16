// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Where in a TOML text its keys and values are written. Not installed.
namespace oblique::text {

/// The way to an entry: keys, and numbers of elements of arrays.
using TomlPath = std::vector<std::variant<std::string, std::size_t>>;

/// A part of a key as it is written: b of "a.b = 1", without blanks, with its quotes.
struct TomlKey {
  std::size_t depth = 0;  ///< of the path of its item: which step it is
  std::size_t begin = 0, end = 0;
};

/// What is written at one place.
struct TomlItem {
  enum class Kind {
    line,     ///< "key = value" below a header, or above all of them
    header,   ///< "[table]" or "[[array]]"
    entry,    ///< "key = value" between braces
    element,  ///< a value between brackets
  };
  Kind kind = Kind::line;
  TomlPath path;                   ///< whole; of "[[array]]" with the number of the table
  std::vector<TomlKey> keys;       ///< all of a header, those that a line or an entry writes itself
  std::size_t begin = 0, end = 0;  ///< from the first key or bracket until after the value
  std::size_t value = 0;           ///< where its value begins; of a header its end
  std::vector<TomlItem> inner;     ///< of a value between brackets or braces

  /// The path of the table that it is written in.
  TomlPath table() const;
};

/// Whether a path leads through another one, or to it.
bool leads_through(const TomlPath& path, const TomlPath& other);

/// What a text that `parse_document` takes has written where, in its order.
std::vector<TomlItem> toml_layout(std::string_view text);

}  // namespace oblique::text
