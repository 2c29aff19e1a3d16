// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oblique::text {

/// Where something stands in a text; lines and columns count from 1, 0 means "not known".
struct SourcePosition {
  int line = 0;
  int column = 0;
  bool operator==(const SourcePosition&) const = default;
};

/// A position in a named file; `file` is empty where the text came from nowhere in particular.
struct Place {
  std::string file;
  SourcePosition position;
  bool operator==(const Place&) const = default;
};

/// One finding about a user's input: where, what is wrong, what was expected, what to do about it.
/// Every part but `what` may be empty.
struct Diagnostic {
  Place place;
  std::string what;
  std::string expected;
  std::string remedy;
};

/// "file:line:column: what; expected …\n  remedy: …": the form every message of Oblique has.
std::string to_string(const Diagnostic& diagnostic);

/// Base of the exceptions the stages throw; carries at least one diagnostic.
class Error : public std::exception {
 public:
  explicit Error(std::vector<Diagnostic> diagnostics);
  explicit Error(Diagnostic diagnostic);

  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  /// All diagnostics in the form of `to_string`, one after the other.
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  std::vector<Diagnostic> diagnostics_;
  std::string message_;
};

/// Thrown by the `text` stage: a file that cannot be opened, broken TOML, a malformed value.
class ReadError : public Error {
 public:
  using Error::Error;
};

/// Collects findings so that one reading reports them together.
class Diagnostics {
 public:
  void add(Diagnostic diagnostic) { items_.push_back(std::move(diagnostic)); }
  bool empty() const { return items_.empty(); }
  std::size_t size() const { return items_.size(); }

  /// Throws `E` with everything collected, ordered by place; does nothing when there is nothing.
  template <class E>
  void throw_if_any() {
    if (!items_.empty()) {
      sort_by_place();
      throw E(std::move(items_));
    }
  }

 private:
  void sort_by_place();
  std::vector<Diagnostic> items_;
};

/// The candidate nearest to `name` in edit distance, if one is near enough to be a slip of the hand.
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// "did you mean 'x'?" for a near candidate, otherwise "known: a, b, c" (or nothing without candidates).
std::string suggest(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace oblique::text
