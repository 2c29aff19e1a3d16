// SPDX-License-Identifier: MIT
// Tables as text: comma-separated values and JSON. Numbers have the fewest digits that read back to the same
// bits.
#include <oblique/text/table_text.h>

#include <cmath>
#include <iterator>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <oblique/text/encoding.h>

namespace oblique::text {
namespace {

/// A field of a CSV file; quoted where it has to be (RFC 4180). What a spreadsheet would take for a formula
/// begins with an apostrophe, which spreadsheets take for "a text follows".
std::string csv_field(const std::string& name) {
  std::string text = visible(name);
  if (!text.empty() && std::string_view("=+-@\t").find(text.front()) != std::string_view::npos)
    text.insert(0, 1, '\'');
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

/// A string of JSON (RFC 8259).
std::string json_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20U) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
      continue;
    }
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

/// The word that stands for a value of the column, or nothing.
const std::string* label_of(const TableColumn& column, double value) {
  if (!(value >= 0 && value < static_cast<double>(column.labels.size()))) return nullptr;
  const auto index = static_cast<std::size_t>(value);
  return static_cast<double>(index) == value ? &column.labels[index] : nullptr;
}

/// Collects text and hands it to the file in large pieces.
class TextFormat : public TableFormat {
 public:
  TextFormat(NewFile& file, const std::vector<TableColumn>& columns) : columns_(columns), file_(file) {}

  void add(std::span<const double> rows) override {
    for (; !rows.empty(); rows = rows.subspan(columns_.size())) {
      add_row(rows.first(columns_.size()));
      constexpr std::size_t kPiece = 262'144;
      if (text_.size() >= kPiece) flush();
    }
  }

  void finish() override {
    end();
    flush();
  }

 protected:
  virtual void add_row(std::span<const double> row) = 0;
  virtual void end() {}

  void put(std::string_view text) { text_.append(text); }
  void put(double number) { fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{}"), number); }

  const std::vector<TableColumn>& columns_;

 private:
  void flush() {
    file_.append({text_.data(), text_.size()});
    text_.clear();
  }

  NewFile& file_;
  fmt::memory_buffer text_;
};

class CsvFormat : public TextFormat {
 public:
  CsvFormat(NewFile& file, const std::vector<TableColumn>& columns) : TextFormat(file, columns) {
    for (std::size_t c = 0; c < columns.size(); ++c) put((c == 0 ? "" : ",") + csv_field(columns[c].name));
    put("\n");
  }

 private:
  void add_row(std::span<const double> row) override {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) put(",");
      if (const std::string* const label = label_of(columns_[c], row[c])) {
        put(csv_field(*label));
      } else if (!std::isnan(row[c])) {
        put(row[c]);
      }
    }
    put("\n");
  }
};

class JsonFormat : public TextFormat {
 public:
  JsonFormat(NewFile& file, const std::vector<TableColumn>& columns) : TextFormat(file, columns) {
    put("{\"columns\": [");
    for (std::size_t c = 0; c < columns.size(); ++c) {
      put(fmt::format(R"({}{{"name": {}, "unit": {}}})", c == 0 ? "" : ", ", json_string(columns[c].name),
                      json_string(columns[c].unit)));
    }
    put("],\n\"rows\": [");
  }

 private:
  void add_row(std::span<const double> row) override {
    put(first_ ? "\n[" : ",\n[");
    first_ = false;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) put(", ");
      if (const std::string* const label = label_of(columns_[c], row[c])) {
        put(json_string(*label));
      } else if (!std::isfinite(row[c])) {
        put("null");
      } else if (row[c] == 0 && std::signbit(row[c])) {
        put("-0.0");  // "-0" is a whole number to many readers, and has no sign there
      } else {
        put(row[c]);
      }
    }
    put("]");
  }

  void end() override { put("\n]}\n"); }

  bool first_ = true;
};

}  // namespace

std::unique_ptr<TableFormat> make_csv_format(NewFile& file, const std::vector<TableColumn>& columns,
                                             std::size_t /*rows*/) {
  return std::make_unique<CsvFormat>(file, columns);
}

std::unique_ptr<TableFormat> make_json_format(NewFile& file, const std::vector<TableColumn>& columns,
                                              std::size_t /*rows*/) {
  return std::make_unique<JsonFormat>(file, columns);
}

}  // namespace oblique::text
