// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/document.h>

namespace oblique::synthesis {

/// The bytes [begin, end) of a text.
struct TextRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Where a number or a string (with its quotes) stands in the text that it was read from.
TextRange range_of(std::string_view text, const text::Value& value);

/// What shall stand in a range.
struct Replacement {
  TextRange range;
  std::string text;
};

/// The text with the ranges, which must not overlap, replaced; every other byte stays.
std::string replace_ranges(std::string_view text, std::vector<Replacement> replacements);

/// The text with a comment as its first line (behind a byte order mark), ended as the text ends its lines.
/// What cannot stand in a comment is replaced by '?'.
std::string with_comment(std::string_view text, std::string comment);

}  // namespace oblique::synthesis
