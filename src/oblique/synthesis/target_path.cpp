// SPDX-License-Identifier: MIT
#include <oblique/synthesis/target_path.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/synthesis/synthesis_error.h>
#include <oblique/text/csv.h>
#include <oblique/text/quantity.h>

namespace oblique::synthesis {
namespace {

/// Times may span a turn and the rounding of a table with few digits (6.2832 for 2π).
constexpr double kOneTurn = 1 + 1e-4;

class TargetPathReader {
 public:
  TargetPathReader(text::CsvTable table, const std::string& file, const mechanism::Mechanism& mechanism)
      : table_(std::move(table)), mechanism_(mechanism) {
    path_.file = file;
  }

  TargetPath read() {
    convert();
    check_columns();
    read_point();
    read_times();
    check_numbers();
    sort();
    return std::move(path_);
  }

 private:
  static bool is_coordinate(const std::string& name) { return name.ends_with(".x") || name.ends_with(".y"); }

  bool is_timing(const std::string& name) const {
    return name == "t" || std::any_of(mechanism_.drives.begin(), mechanism_.drives.end(),
                                      [&](const mechanism::Drive& drive) { return drive.name == name; });
  }

  std::string unit_of(const std::string& column) const {
    if (is_coordinate(column)) return mechanism_.length_unit;
    if (column == "t") return "s";
    const auto drive = std::find_if(mechanism_.drives.begin(), mechanism_.drives.end(),
                                    [&](const mechanism::Drive& one) { return one.name == column; });
    return drive->slide ? mechanism_.length_unit : "rad";
  }

  /// Takes the units from the headings: coordinates to the mechanism's unit of length, times to seconds,
  /// drives' angles to radians.
  void convert() {
    for (std::size_t c = 0; c < table_.names.size(); ++c) {
      const text::CsvHeading heading = text::split_heading(table_.names[c]);
      if (heading.unit.empty() || !(is_coordinate(heading.name) || is_timing(heading.name))) continue;
      table_.names[c] = heading.name;
      const std::string wanted = unit_of(heading.name);
      const auto unit = text::parse_unit(heading.unit);
      const auto factor = unit ? text::factor_between(*unit, text::parse_unit(wanted).value()) : std::nullopt;
      if (!factor)
        fail(fmt::format("column '{}' is in [{}]", heading.name, heading.unit),
             fmt::format("a unit that can be turned into [{}]", wanted), {});
      for (double& value : table_.columns[c]) value *= *factor;
    }
  }

  void check_columns() const {
    const auto& names = table_.names;
    for (const std::string& name : names) {
      if (!is_coordinate(name) && !is_timing(name)) {
        fail(fmt::format("column '{}' belongs to no path", name), expected(), text::suggest(name, known()));
      }
      if (std::count(names.begin(), names.end(), name) > 1)
        fail(fmt::format("there are two columns '{}'", name), "one of each", {});
    }
  }

  void read_point() {
    std::optional<std::string> point;
    for (const std::string& name : table_.names) {
      if (!is_coordinate(name)) continue;
      const std::string owner = name.substr(0, name.size() - 2);
      if (point && owner != *point) {
        fail(fmt::format("there are columns of two points, '{}' and '{}'", *point, owner),
             "the path of one point", "leave the columns of the other out");
      }
      point = owner;
    }
    if (!point) fail("there are no columns of a point", expected(), text::suggest({}, known()));
    const auto index = mechanism_.find_point(*point);
    if (!index) {
      fail(fmt::format("column '{}.x': the mechanism has no point '{}'", *point, *point), expected(),
           text::suggest(*point, moving_points()));
    }
    if (mechanism_.points[*index].fixed) {
      fail(fmt::format("point '{}' is fixed in the frame and has no path", *point), expected(),
           text::suggest({}, moving_points()));
    }
    path_.point = *index;
    const std::vector<double>& x = column(*point + ".x");
    const std::vector<double>& y = column(*point + ".y");
    for (std::size_t row = 0; row < x.size(); ++row) path_.positions.emplace_back(x[row], y[row]);
  }

  const std::vector<double>& column(const std::string& name) const {
    const std::vector<double>* const found = table_.find(name);
    if (found == nullptr) fail(fmt::format("there is no column '{}'", name), expected(), {});
    return *found;
  }

  void read_times() {
    for (const std::string& name : table_.names) {
      if (!is_timing(name)) continue;
      if (!path_.timing.empty()) {
        fail(fmt::format("columns '{}' and '{}' both tell when", path_.timing, name), "one of them", {});
      }
      path_.timing = name;
      path_.times = *table_.find(name);
    }
    if (path_.timing.empty() || path_.timing == "t") return;
    const mechanism::Drive& drive =
        *std::find_if(mechanism_.drives.begin(), mechanism_.drives.end(),
                      [&](const mechanism::Drive& candidate) { return candidate.name == path_.timing; });
    for (double& value : path_.times) value = (value - drive.start) / drive.speed;
  }

  void check_numbers() const {
    for (std::size_t row = 0; row < path_.positions.size(); ++row) {
      if (path_.positions[row].allFinite() && (path_.times.empty() || std::isfinite(path_.times[row])))
        continue;
      fail(fmt::format("row {} is not finite", row + 1), "finite numbers", "leave the row out");
    }
    if (path_.times.empty()) return;
    const auto [first, last] = std::minmax_element(path_.times.begin(), path_.times.end());
    const double turns = (*last - *first) / mechanism::period(mechanism_);
    if (turns <= kOneTurn) return;
    fail(fmt::format("column '{}' spans {:.6g} turns of drive '{}'", path_.timing, turns,
                     mechanism_.drives.front().name),
         fmt::format("one turn at most, in {}", path_.timing == "t" ? "[s]" : "[rad]"),
         path_.timing == "t" ? ""
                             : fmt::format("head the column '{} [deg]' if it is in degrees", path_.timing));
  }

  void sort() {
    if (path_.times.empty()) return;
    std::vector<std::size_t> order(path_.times.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return path_.times[a] < path_.times[b]; });
    TargetPath sorted = path_;
    for (std::size_t row = 0; row < order.size(); ++row) {
      sorted.times[row] = path_.times[order[row]];
      sorted.positions[row] = path_.positions[order[row]];
    }
    path_ = std::move(sorted);
  }

  std::vector<std::string> moving_points() const {
    std::vector<std::string> names;
    for (const mechanism::Point& point : mechanism_.points) {
      if (!point.fixed) names.push_back(point.name);
    }
    return names;
  }

  std::vector<std::string> known() const {
    std::vector<std::string> names;
    for (const std::string& point : moving_points()) {
      names.push_back(point + ".x");
      names.push_back(point + ".y");
    }
    for (const mechanism::Drive& drive : mechanism_.drives) names.push_back(drive.name);
    names.emplace_back("t");
    return names;
  }

  static std::string expected() {
    return "columns P.x and P.y of a moving point P, and beside them a drive's angle [rad], t [s] or nothing";
  }

  [[noreturn]] void fail(std::string what, std::string expected, std::string remedy) const {
    throw SynthesisError(
        SynthesisError::Kind::request,
        text::Diagnostic{{path_.file, {}}, std::move(what), std::move(expected), std::move(remedy)});
  }

  text::CsvTable table_;
  const mechanism::Mechanism& mechanism_;
  TargetPath path_;
};

}  // namespace

TargetPath read_target_path(std::string_view csv, const std::string& file,
                            const mechanism::Mechanism& mechanism) {
  return TargetPathReader(text::parse_csv(csv, file), file, mechanism).read();
}

}  // namespace oblique::synthesis
