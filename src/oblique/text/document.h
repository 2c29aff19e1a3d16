// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/diagnostic.h>

namespace oblique::text {

struct Entry;

/// One value of a TOML file with its position; tables keep the order of the file.
struct Value {
  enum class Kind { boolean, number, string, array, table, date };
  Kind kind = Kind::table;
  SourcePosition position;
  bool boolean = false;
  double number = 0;            ///< integers too
  std::string text;             ///< of a string
  std::vector<Value> elements;  ///< of an array
  std::vector<Entry> entries;   ///< of a table

  /// The value of a key of a table, or nothing.
  const Value* find(std::string_view key) const;
};

/// A key of a table and its value.
struct Entry {
  std::string key;
  SourcePosition position;  ///< of the key
  Value value;
};

/// A whole TOML 1.0 file.
struct Document {
  std::string file;
  Value root;
};

/// "a string", "a table": the kind of a value as a message names it.
std::string_view kind_name(Value::Kind kind);

/// Parses TOML 1.0; `file` is the name that messages give. Throws ReadError.
Document parse_document(std::string_view text, std::string file);

/// `read_file` and `parse_document`.
Document read_document(const std::filesystem::path& path);

}  // namespace oblique::text
