// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/document.h>
#include <oblique/text/quantity.h>

namespace oblique::text {

/// Reads the keys of one table, adding every finding to a `Diagnostics` instead of stopping at the first.
/// Each getter marks its key as known; `finish` reports the keys nobody asked for, with the nearest known
/// name.
class TableReader {
 public:
  /// `what` names the table in messages ("[run]", "block 'phi'"); the references must outlive the reader.
  TableReader(std::string file, const Value& table, std::string what, Diagnostics& diagnostics);

  const Value& table() const { return *table_; }
  const std::string& what() const { return what_; }

  /// The value of a key of any kind, or nothing.
  const Value* find(std::string_view key);

  /// Typed getters: empty where the key is absent or has another kind (which is then reported).
  std::optional<std::string> string(std::string_view key);
  std::optional<bool> boolean(std::string_view key);
  /// A number, a constant expression or a quantity, in `unit`.
  std::optional<double> quantity(std::string_view key, std::string_view unit, const NameLookup& lookup = {});
  std::optional<double> quantity(std::string_view key, const Unit& unit, const NameLookup& lookup = {});
  /// A sub-table.
  const Value* table(std::string_view key);
  /// An array of strings; a lone string counts as one where `allow_single`.
  std::optional<std::vector<std::string>> strings(std::string_view key, bool allow_single = false);

  /// As `string` and friends, but an absent key is reported; `expected` says what should stand there.
  std::optional<std::string> required_string(std::string_view key, std::string_view expected);
  std::optional<double> required_quantity(std::string_view key, std::string_view unit);
  std::optional<double> required_quantity(std::string_view key, const Unit& unit);

  /// Reports a finding at the value of `key`, or at the table where the key is absent.
  void report(std::string_view key, std::string what, std::string expected = {}, Remedy remedy = {});

  /// Reports unknown keys.
  void finish();

  Place place(SourcePosition position) const { return {file_, position}; }

 private:
  const Value* expect(std::string_view key, Value::Kind kind);
  void report_absent(std::string_view key, std::string expected);

  std::string file_;
  const Value* table_;
  std::string what_;
  Diagnostics* diagnostics_;
  std::vector<std::string> known_;
};

/// A number or a string holding a quantity, in `unit` (which must be one `parse_unit` knows); a finding (also
/// of not-a- number; infinity is a number) goes to `diagnostics` with `what` as the subject of the sentence.
std::optional<double> read_quantity(const std::string& file, const Value& value, std::string_view unit,
                                    const std::string& what, Diagnostics& diagnostics,
                                    const NameLookup& lookup = {});

/// The same in a unit that knows more than its name.
std::optional<double> read_quantity(const std::string& file, const Value& value, const Unit& unit,
                                    const std::string& what, Diagnostics& diagnostics,
                                    const NameLookup& lookup = {});

/// Turns the error of an expression inside a string value into a diagnostic at the right column (of a string
/// of several lines: at its beginning).
Diagnostic to_diagnostic(const ExpressionError& error, const std::string& file, const Value& string_value,
                         const std::string& what);

/// What a line of `[expect]` gives: a value and how far from it counts as met.
struct ExpectedValue {
  double value = 0;
  double within = 0;
};

/// Reads `{ value = …, within = … }`, both in the unit of what is expected; nothing after a finding.
std::optional<ExpectedValue> read_expected_value(TableReader& reader, const Unit& unit = {});

/// Checks `format = "oblique-…/1"`; reports what else stands there. False where that is a file of another
/// kind, of which nothing else is worth a finding.
[[nodiscard]] bool check_format(TableReader& reader, std::string_view expected);

}  // namespace oblique::text
