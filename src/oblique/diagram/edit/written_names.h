// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// The names in expressions as a file has them, wrong or not. Not installed.
namespace oblique::diagram {

bool is_name_character(char c);

/// The names in an expression that are no functions, each with where it begins: "c", "b.cos".
std::vector<std::pair<std::size_t, std::string>> written_names(const std::string& text);

/// The block that a path of names begins with.
std::string_view block_of(std::string_view signal);

/// An expression in which a block has another name.
std::string with_other_name(const std::string& text, const std::string& block, const std::string& name);

}  // namespace oblique::diagram
