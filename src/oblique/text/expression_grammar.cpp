// SPDX-License-Identifier: MIT
#include <oblique/text/expression_grammar.h>

#include <algorithm>
#include <initializer_list>

namespace oblique::text {
namespace {

/// The bytes of the first of `spellings` that begins at `at`.
std::size_t length_at(std::string_view text, std::size_t at,
                      std::initializer_list<std::string_view> spellings) {
  const std::string_view rest = text.substr(std::min(at, text.size()));
  for (const std::string_view spelling : spellings) {
    if (rest.starts_with(spelling)) return spelling.size();
  }
  return 0;
}

}  // namespace

const FunctionInfo* find_function(std::string_view name) {
  const auto found = std::find_if(functions().begin(), functions().end(),
                                  [&](const FunctionInfo& f) { return f.name == name; });
  return found == functions().end() ? nullptr : &*found;
}

const BinaryOperator* operator_of(Expression::Kind kind) {
  const auto* const found = std::find_if(kBinaryOperators.begin(), kBinaryOperators.end(),
                                         [&](const BinaryOperator& op) { return op.kind == kind; });
  return found == kBinaryOperators.end() ? nullptr : found;
}

std::size_t minus_at(std::string_view text, std::size_t at) {
  return length_at(text, at, {"-", "\u2212", "\u2013"});
}

std::size_t space_at(std::string_view text, std::size_t at) {
  return length_at(text, at, {" ", "\t", "\n", "\r", "\u00a0", "\u2009", "\u202f"});
}

}  // namespace oblique::text
