// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace oblique::text {

/// Where something stands in a text; lines and columns count from 1, 0 means "not known".
struct SourcePosition {
  int line = 0;
  int column = 0;
  bool operator==(const SourcePosition&) const = default;
};

/// Something that the caller may set beside the files, by its name in the options of the library ("until",
/// "bandwidth"), and the value that is meant, as it is written; empty for whatever value.
struct Setting {
  std::string name;
  std::string value = {};
  bool operator==(const Setting&) const = default;
};

/// Something that the caller may do, by the name of the function ("check"), with a file or a folder where it
/// is known.
struct Action {
  std::string name;
  std::string subject = {};
  bool operator==(const Action&) const = default;
};

/// How settings and actions are spelled to the reader of a message: the program says "--until" and
/// "oblique check", another host what its users know.
struct Vocabulary {
  std::function<std::string(const Setting&)> setting;
  std::function<std::string(const Action&)> action;
};

/// "'until'", "bandwidth 20 Hz", "'check'": the words of the library itself.
const Vocabulary& plain_vocabulary();

/// What would help, in words, with the settings and actions of the caller as data.
class Remedy {
 public:
  using Piece = std::variant<std::string, Setting, Action>;

  Remedy() = default;
  Remedy(std::string words);       // NOLINT(google-explicit-constructor): most are words alone
  Remedy(const char* words);       // NOLINT(google-explicit-constructor)
  Remedy(std::string_view words);  // NOLINT(google-explicit-constructor)
  Remedy(std::initializer_list<Piece> pieces) : pieces_(pieces) {}

  bool empty() const { return pieces_.empty(); }
  Remedy& operator+=(const Remedy& more);
  std::string words(const Vocabulary& vocabulary = plain_vocabulary()) const;

  bool operator==(std::string_view text) const { return words() == text; }
  friend std::ostream& operator<<(std::ostream& out, const Remedy& remedy);

 private:
  std::vector<Piece> pieces_;
};

/// A position in a named file, or a setting; `file` is empty where the text came from nowhere in particular.
struct Place {
  std::string file;
  SourcePosition position = {};
  Setting setting = {};
  bool operator==(const Place&) const = default;
};

/// One finding about a user's input: where, what is wrong, what was expected, what to do about it.
/// Every part but `what` may be empty.
struct Diagnostic {
  Place place;
  std::string what;
  std::string expected;
  Remedy remedy;
};

/// "file:line:column: what; expected …\n  remedy: …": the form every message of Oblique has.
std::string to_string(const Diagnostic& diagnostic, const Vocabulary& vocabulary = plain_vocabulary());

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
