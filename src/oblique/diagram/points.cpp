// SPDX-License-Identifier: MIT
#include <oblique/diagram/points.h>

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <oblique/text/csv.h>
#include <oblique/text/table_reader.h>

namespace oblique {
namespace {

class PointReader {
 public:
  PointReader(const std::string& file, const std::string& subject, Diagnostics& diagnostics)
      : file_(file), subject_(subject), diagnostics_(diagnostics) {}

  std::optional<PointTable> read(const Value& value) {
    std::optional<PointTable> table;
    if (value.kind == Value::Kind::array) {
      table = from_list(value);
    } else if (value.kind == Value::Kind::table) {
      table = from_file(value);
    } else {
      return report(value.position, fmt::format("is {}", kind_name(value.kind)),
                    R"([[x, y], …], or { file = "data.csv", x = "COLUMN", y = "COLUMN" })");
    }
    if (table) check(value.position, *table);
    return table;
  }

 private:
  std::nullopt_t report(SourcePosition position, const std::string& what, std::string expected) {
    diagnostics_.add({{file_, position}, fmt::format("{} {}", subject_, what), std::move(expected), {}});
    return std::nullopt;
  }

  std::optional<PointTable> from_list(const Value& list) {
    PointTable table;
    for (const Value& point : list.elements) {
      if (point.kind != Value::Kind::array || point.elements.size() != 2)
        return report(point.position, "has something else than a point", "[x, y]");
      const auto x = read_quantity(file_, point.elements[0], "1", subject_, diagnostics_);
      const auto y = read_quantity(file_, point.elements[1], "1", subject_, diagnostics_);
      if (!x || !y) return std::nullopt;
      table.x.push_back(*x);
      table.y.push_back(*y);
    }
    return table;
  }

  std::optional<PointTable> from_file(const Value& value) {
    TableReader reader(file_, value, subject_, diagnostics_);
    const auto name = reader.required_string("file", "the name of a CSV file");
    const auto x = reader.required_string("x", "the name of the column of the argument");
    const auto y = reader.required_string("y", "the name of the column of the value");
    reader.finish();
    if (!name || !x || !y) return std::nullopt;
    const std::filesystem::path path = std::filesystem::path(file_).parent_path() / *name;
    try {
      const CsvTable csv = parse_csv(read_file(path), path.string());
      for (const auto& [key, column] : {std::pair{"x", *x}, std::pair{"y", *y}}) {
        if (csv.find(column) == nullptr) {
          diagnostics_.add({{file_, value.find(key)->position},
                            fmt::format("{}: '{}' has no column '{}'", subject_, path.string(), column),
                            {},
                            suggest(column, csv.names)});
        }
      }
      if (csv.find(*x) == nullptr || csv.find(*y) == nullptr) return std::nullopt;
      return PointTable{*csv.find(*x), *csv.find(*y)};
    } catch (const ReadError& error) {
      for (const Diagnostic& finding : error.diagnostics()) diagnostics_.add(finding);
      return std::nullopt;
    }
  }

  void check(SourcePosition position, const PointTable& table) {
    if (table.x.size() < 2) {
      report(position, fmt::format("has {} points", table.x.size()), "at least two points");
      return;
    }
    for (std::size_t i = 0; i < table.x.size(); ++i) {
      if (!std::isfinite(table.x[i]) || !std::isfinite(table.y[i])) {
        report(position, "has a point that is not finite", "finite numbers");
        return;
      }
      if (i > 0 && !(table.x[i] > table.x[i - 1])) {
        report(position, fmt::format("has x = {} after x = {}", table.x[i], table.x[i - 1]),
               "points whose x rises from one to the next");
        return;
      }
    }
  }

  const std::string& file_;
  const std::string& subject_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::optional<PointTable> read_points(const std::string& file, const Value& value, const std::string& subject,
                                      Diagnostics& diagnostics) {
  return PointReader(file, subject, diagnostics).read(value);
}

}  // namespace oblique
