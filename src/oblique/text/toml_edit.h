// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/toml_layout.h>

/// Changes of a TOML text at the places of its entries: comments, order and formatting of the rest stay. Not
/// installed.
namespace oblique::text {

/// A change of one entry.
struct TomlChange {
  enum class Kind {
    set,     ///< to the value that `text` writes; an entry that there is not is added at the end of its table
             ///< or array, a table that there is not at the end of the text
    remove,  ///< with its line, or its comma
    rename,  ///< its key to `text`
  };
  Kind kind = Kind::set;
  TomlPath path;
  std::string text;
};

/// The text with the changes, one after the other. What it then says is read again and held against what the
/// changes mean. Throws ReadError for broken TOML, and where the text cannot be changed so.
std::string edit_toml(std::string_view text, const std::string& file, const std::vector<TomlChange>& changes);

}  // namespace oblique::text
