// SPDX-License-Identifier: MIT
#include <oblique/diagram/points.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <oblique/text/csv.h>
#include <oblique/text/file.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {
namespace {

class PointReader {
 public:
  PointReader(const std::string& file, const PointUnits& units, const std::string& subject,
              text::Diagnostics& diagnostics)
      : file_(file), units_(units), subject_(subject), diagnostics_(diagnostics) {}

  std::optional<text::PointTable> read(const text::Value& value) {
    std::optional<text::PointTable> table;
    bool hold = false;
    if (value.kind == text::Value::Kind::array) {
      table = from_list(value);
    } else if (value.kind == text::Value::Kind::table) {
      table = from_table(value, hold);
    } else {
      return report(value.position, fmt::format("is {}", text::kind_name(value.kind)),
                    R"([[x, y], …], or { file = "data.csv", x = "COLUMN", y = "COLUMN" })");
    }
    if (table && check(value.position, *table)) continue_ends(*table, hold);
    return table;
  }

 private:
  std::nullopt_t report(text::SourcePosition position, const std::string& what, std::string expected,
                        std::string remedy = {}) {
    diagnostics_.add(
        {{file_, position}, fmt::format("{} {}", subject_, what), std::move(expected), std::move(remedy)});
    return std::nullopt;
  }

  std::optional<text::PointTable> from_list(const text::Value& list) {
    text::PointTable table;
    for (const text::Value& point : list.elements) {
      const std::size_t numbers = point.kind == text::Value::Kind::array ? point.elements.size() : 0;
      if (numbers != 2) {
        return report(point.position, "has something other than a point", "[x, y]",
                      numbers > 2 ? "numbers have a decimal point, not a comma" : "");
      }
      const auto x = text::read_quantity(file_, point.elements[0], units_.x, subject_, diagnostics_);
      const auto y = text::read_quantity(file_, point.elements[1], units_.y, subject_, diagnostics_);
      if (!x || !y) return std::nullopt;
      table.x.push_back(*x);
      table.y.push_back(*y);
    }
    return table;
  }

  std::optional<text::PointTable> from_table(const text::Value& value, bool& hold) {
    text::TableReader reader(file_, value, subject_, diagnostics_);
    for (const char* const key : {"at_zero", "slope", "segments"}) {
      if (value.find(key) != nullptr) return from_slopes(reader);
    }
    if (const auto beyond = reader.string("beyond")) {
      hold = *beyond == "hold";
      if (!hold && *beyond != "extrapolate") {
        reader.report("beyond", fmt::format("{}: 'beyond' is '{}'", subject_, *beyond),
                      "what holds before the first and after the last point: \"hold\", their values, or "
                      "\"extrapolate\", the lines through the nearest two");
      }
    }
    if (const text::Value* const points = reader.find("points")) {
      reader.finish();
      if (points->kind == text::Value::Kind::array) return from_list(*points);
      return report(points->position, fmt::format("has points that are {}", text::kind_name(points->kind)),
                    "[[x, y], …]");
    }
    const auto name = reader.required_string("file", "the name of a CSV file");
    const auto x = reader.required_string("x", "the name of the column of the argument");
    const auto y = reader.required_string("y", "the name of the column of the value");
    reader.finish();
    if (!name || !x || !y) return std::nullopt;
    const std::filesystem::path path = std::filesystem::path(file_).parent_path() / *name;
    try {
      const text::CsvTable csv = text::parse_csv(text::read_file(path), path.string());
      const auto of_x = column(csv, *x, units_.x, value.find("x")->position, path);
      const auto of_y = column(csv, *y, units_.y, value.find("y")->position, path);
      if (!of_x || !of_y) return std::nullopt;
      return text::PointTable{*of_x, *of_y};
    } catch (const text::ReadError& error) {
      for (const text::Diagnostic& finding : error.diagnostics()) diagnostics_.add(finding);
      return std::nullopt;
    }
  }

  /// Where a line of the function begins, counted from 0 outwards, and its slope.
  struct Segment {
    double breakpoint, slope;
  };

  /// A function as the sheet of a diode function generator has it: value and slope at 0, and the slopes
  /// beyond its breakpoints.
  std::optional<text::PointTable> from_slopes(text::TableReader& reader) {
    const text::Unit slope_unit = slope_of(units_);
    const auto at_zero = reader.required_quantity("at_zero", units_.y);
    const auto slope = reader.required_quantity("slope", slope_unit);
    const text::Value* const list = reader.find("segments");
    reader.finish();
    if (list == nullptr || list->kind != text::Value::Kind::array || list->elements.empty())
      return report((list != nullptr ? *list : reader.table()).position, "has no segments",
                    "segments = [[breakpoint, slope beyond it], …], at least one");
    std::vector<Segment> below, above;  // from 0 outwards
    for (const text::Value& element : list->elements) {
      if (element.kind != text::Value::Kind::array || element.elements.size() != 2)
        return report(element.position, "has something other than a segment",
                      "[breakpoint, slope beyond it]");
      const auto x = text::read_quantity(file_, element.elements[0], units_.x, subject_, diagnostics_);
      const auto beyond = text::read_quantity(file_, element.elements[1], slope_unit, subject_, diagnostics_);
      if (!x || !beyond) return std::nullopt;
      std::vector<Segment>& side = *x < 0 ? below : above;
      const auto same = [&](const Segment& other) { return other.breakpoint == *x; };
      if (std::any_of(side.begin(), side.end(), same))
        return report(element.position, fmt::format("has two segments from {} on", *x),
                      "breakpoints that differ");
      side.push_back({*x, *beyond});
    }
    if (!at_zero || !slope) return std::nullopt;
    const auto nearer = [](const Segment& a, const Segment& b) {
      return std::abs(a.breakpoint) < std::abs(b.breakpoint);
    };
    std::sort(below.begin(), below.end(), nearer);
    std::sort(above.begin(), above.end(), nearer);
    text::PointTable table = outwards(-1, *at_zero, *slope, below);
    std::reverse(table.x.begin(), table.x.end());
    std::reverse(table.y.begin(), table.y.end());
    const text::PointTable right = outwards(1, *at_zero, *slope, above);
    table.x.insert(table.x.end(), right.x.begin(), right.x.end());
    table.y.insert(table.y.end(), right.y.begin(), right.y.end());
    return table;
  }

  /// The breakpoints on one side of 0, and a point beyond them, by which the last line goes on.
  static text::PointTable outwards(double side, double y, double slope,
                                   const std::vector<Segment>& segments) {
    text::PointTable table;
    double x = 0;
    const auto add = [&](double next) {
      y += slope * (next - x);
      x = next;
      table.x.push_back(x);
      table.y.push_back(y);
    };
    for (const Segment& segment : segments) {
      add(segment.breakpoint);
      slope = segment.slope;
    }
    add(x + side * std::max(1.0, std::abs(x)));
    return table;
  }

  /// Of y over x.
  static text::Unit slope_of(const PointUnits& units) {
    text::Unit unit = units.y;
    unit.name = units.x.name == units.y.name ? "1" : units.y.name + "/" + units.x.name;
    unit.scale /= units.x.scale;
    for (std::size_t k = 0; k < unit.exponents.size(); ++k) unit.exponents[k] -= units.x.exponents[k];
    return unit;
  }

  /// A column in the unit that is wanted, where its heading tells one that can stand for it.
  std::optional<std::vector<double>> column(const text::CsvTable& csv, const std::string& name,
                                            const text::Unit& wanted, text::SourcePosition position,
                                            const std::filesystem::path& path) {
    const auto index = csv.index_of(name);
    if (!index) {
      diagnostics_.add({{file_, position},
                        fmt::format("{}: '{}' has no column '{}'", subject_, path.string(), name),
                        {},
                        text::suggest(name, csv.names)});
      return std::nullopt;
    }
    std::vector<double> values = csv.columns[*index];
    const auto unit = text::parse_unit(text::split_heading(csv.names[*index]).unit);
    const auto factor = unit ? text::factor_between(*unit, wanted) : std::nullopt;
    for (double& value : values) value *= factor.value_or(1);
    return values;
  }

  bool check(text::SourcePosition position, const text::PointTable& table) {
    const std::vector<double>& x = table.x;
    const std::size_t before = diagnostics_.size();
    if (x.size() < 2) report(position, fmt::format("has {} points", x.size()), "at least two points");
    for (std::size_t i = 0; i < x.size() && diagnostics_.size() == before; ++i) {
      if (!std::isfinite(x[i]) || !std::isfinite(table.y[i])) {
        report(position, "has a point that is not finite", "finite numbers");
      } else if (i > 0 && !(x[i] >= x[i - 1])) {
        report(position, fmt::format("has x = {} after x = {}", x[i], x[i - 1]),
               "points whose x rises from one to the next");
      } else if (i > 1 && x[i] == x[i - 2]) {
        report(position, fmt::format("has more than two points at x = {}", x[i]),
               "one, or two that make a jump", "keep the first and the last of them");
      }
    }
    return diagnostics_.size() == before;
  }

  /// What is to hold before and after all points, where the line through the nearest two does not say it.
  static void continue_ends(text::PointTable& table, bool hold) {
    std::vector<double>&x = table.x, &y = table.y;
    if (hold || x[0] == x[1]) {
      x.insert(x.begin(), before(x.front()));
      y.insert(y.begin(), y.front());
    }
    if (hold || x[x.size() - 1] == x[x.size() - 2]) {
      x.push_back(-before(-x.back()));
      y.push_back(y.back());
    }
  }

  /// A number well below x.
  static double before(double x) { return x - std::max(1.0, std::abs(x)); }

  const std::string& file_;
  const PointUnits& units_;
  const std::string& subject_;
  text::Diagnostics& diagnostics_;
};

}  // namespace

std::optional<text::PointTable> read_points(const std::string& file, const text::Value& value,
                                            const PointUnits& units, const std::string& subject,
                                            text::Diagnostics& diagnostics) {
  return PointReader(file, units, subject, diagnostics).read(value);
}

}  // namespace oblique::diagram
