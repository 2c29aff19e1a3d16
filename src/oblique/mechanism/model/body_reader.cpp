// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/body_reader.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/triad/triangle.h>
#include <oblique/text/expression.h>

namespace oblique::mechanism {
namespace {

/// Sides whose triangle inequality fails by no more than this, relative to the longest, are a flat triangle.
constexpr double kFlatWithin = 1e-12;

bool is_length(double value) {
  return value >= kShortest && value <= kLongest;
}

std::string expected_length(double value) {
  return value > 0 && std::isfinite(value) ? fmt::format("a length from {} to {}", kShortest, kLongest)
                                           : "a length above 0";
}

/// Reads one body; a finding leaves it out of the mechanism or leaves it incomplete, which the error hides.
class BodyReader {
 public:
  BodyReader(const text::Entry& entry, Mechanism& mechanism, text::Diagnostics& diagnostics)
      : reader_(mechanism.file, entry.value, fmt::format("body '{}'", entry.key), diagnostics),
        mechanism_(mechanism),
        diagnostics_(diagnostics) {
    body_.name = entry.key;
    body_.place = reader_.place(entry.position);
  }

  void read() {
    if (reader_.table().kind != text::Value::Kind::table) return;  // reported by the reader
    const std::vector<std::string> names = point_names();
    const auto length = positive_length("length");
    const text::Value* const sides = reader_.find("sides");
    const auto turn = reader_.string("turn");
    if (names.size() == 2) {
      read_bar(names, length, sides != nullptr || turn);
    } else if (names.size() == 3) {
      read_triangle(names, sides, turn);
    }
    read_marks();
    body_.mass = positive("mass", "kg").value_or(0);
    body_.width = positive("width", mechanism_.length_unit).value_or(0);
    reader_.finish();
    check_distances();
    check_frame();
    mechanism_.bodies.push_back(std::move(body_));
  }

 private:
  std::vector<std::string> point_names() {
    constexpr auto kExpected = R"(points = ["A", "B"] or three points)";
    const auto names = reader_.strings("points");
    if (!names) {
      if (reader_.table().find("points") == nullptr) {
        reader_.report("points", fmt::format("{} has no 'points'", reader_.what()), kExpected);
      }
      return {};
    }
    if (names->size() < 2 || names->size() > 3) {
      reader_.report(
          "points", fmt::format("{} has {} points", reader_.what(), names->size()), "two or three",
          names->size() > 3 ? "keep the first two and give the others as marks = { F = [along, left] }" : "");
      return {};
    }
    return *names;
  }

  /// A length above zero; a finding otherwise.
  std::optional<double> positive_length(const std::string& key) {
    const auto length = reader_.quantity(key, mechanism_.length_unit);
    if (length && !is_length(*length)) {
      reader_.report(key, fmt::format("'{}' of {} is {}", key, reader_.what(), *length),
                     expected_length(*length));
      return std::nullopt;
    }
    return length;
  }

  std::optional<double> positive(const std::string& key, std::string_view unit) {
    const auto value = reader_.quantity(key, unit);
    if (!value || (*value > 0 && std::isfinite(*value))) return value;
    reader_.report(key, fmt::format("'{}' of {} is {}", key, reader_.what(), *value),
                   fmt::format("a number above 0 [{}]", unit));
    return std::nullopt;
  }

  void read_bar(const std::vector<std::string>& names, std::optional<double> length, bool has_triangle_keys) {
    if (has_triangle_keys) {
      reader_.report("sides",
                     fmt::format("{} has two points; 'sides' and 'turn' are for three", reader_.what()),
                     "length = the distance of the two points");
    } else if (!length && reader_.table().find("length") == nullptr) {
      reader_.report("length", fmt::format("{} has no 'length'", reader_.what()),
                     fmt::format("the distance of {} and {}", names[0], names[1]));
    }
    add_point(names[0], Eigen::Vector2d::Zero(), "points");
    // a missing length has been reported; 1 keeps the other findings sensible
    add_point(names[1], {length.value_or(1), 0}, "points");
  }

  void read_triangle(const std::vector<std::string>& names, const text::Value* sides,
                     const std::optional<std::string>& turn) {
    if (reader_.table().find("length") != nullptr) {
      reader_.report("length", fmt::format("{} has three points and a 'length'", reader_.what()),
                     "sides = [first to second, second to third, third to first]");
    }
    if (!turn && reader_.table().find("turn") == nullptr) {
      reader_.report("turn", fmt::format("{} has three points and no 'turn'", reader_.what()),
                     fmt::format(R"(turn = "left" or "right": the side of {} → {} on which {} lies)",
                                 names[0], names[1], names[2]));
    } else if (turn && *turn != "left" && *turn != "right") {
      reader_.report("turn", fmt::format("'turn' of {} is \"{}\"", reader_.what(), *turn),
                     R"("left" or "right")");
    }
    const auto lengths = side_lengths(sides, names);
    if (!lengths) {
      for (const std::string& name : names)
        add_point(name, Eigen::Vector2d::Constant(std::nan("")), "points");
      return;
    }
    const auto& [base, second, third] = *lengths;
    const Triangle shape = triangle(base, third, second);
    if (shape.slack < -kFlatWithin * std::max({base, second, third})) {
      reader_.report(
          "sides",
          fmt::format("sides {}, {} and {} of {} make no triangle", base, second, third, reader_.what()),
          "each side no longer than the other two together",
          fmt::format("the order is |{0} {1}|, |{1} {2}|, |{2} {0}|", names[0], names[1], names[2]));
    }
    add_point(names[0], Eigen::Vector2d::Zero(), "points");
    add_point(names[1], {base, 0}, "points");
    add_point(names[2], {shape.along, turn == "right" ? -shape.height : shape.height}, "points");
  }

  std::optional<std::array<double, 3>> side_lengths(const text::Value* sides,
                                                    const std::vector<std::string>& names) {
    const std::string expected =
        fmt::format("sides = [|{0} {1}|, |{1} {2}|, |{2} {0}|]", names[0], names[1], names[2]);
    if (sides == nullptr || sides->kind != text::Value::Kind::array || sides->elements.size() != 3) {
      reader_.report("sides",
                     sides == nullptr ? fmt::format("{} has three points and no 'sides'", reader_.what())
                                      : fmt::format("'sides' of {} are not three lengths", reader_.what()),
                     expected);
      return std::nullopt;
    }
    std::array<double, 3> lengths{};
    bool good = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const text::Value& side = sides->elements[i];
      const std::string what = fmt::format("side {} of {}", i + 1, reader_.what());
      const auto length =
          text::read_quantity(mechanism_.file, side, mechanism_.length_unit, what, diagnostics_);
      lengths[i] = length.value_or(0);
      if (length && !is_length(*length)) {
        diagnostics_.add({reader_.place(side.position),
                          fmt::format("{} is {}", what, *length),
                          expected_length(*length),
                          {}});
      }
      good = good && is_length(lengths[i]);
    }
    return good ? std::optional(lengths) : std::nullopt;
  }

  void read_marks() {
    const text::Value* const marks = reader_.table("marks");
    if (marks == nullptr) return;
    for (const text::Entry& mark : marks->entries) {
      const std::string what = fmt::format("mark '{}' of {}", mark.key, reader_.what());
      const auto local =
          read_coordinates(mechanism_.file, mark.value, mechanism_.length_unit, what, diagnostics_);
      add_point(mark.key, local.value_or(Eigen::Vector2d::Constant(std::nan(""))), mark.position);
    }
  }

  void add_point(const std::string& name, const Eigen::Vector2d& local, std::string_view key) {
    add_point(name, local, reader_.table().find(key)->position);
  }

  void add_point(const std::string& name, const Eigen::Vector2d& local, text::SourcePosition position) {
    if (!check_name("point", name, reader_.place(position), diagnostics_)) return;
    auto index = mechanism_.find_point(name);
    if (index && body_.find(*index) != nullptr) {
      diagnostics_.add({reader_.place(position),
                        fmt::format("{} names point '{}' twice", reader_.what(), name),
                        "a name for each point",
                        {}});
      return;
    }
    if (!index) {
      index = mechanism_.points.size();
      mechanism_.points.push_back({name, false, Eigen::Vector2d::Zero()});
    }
    body_.points.push_back({*index, local});
  }

  void check_distances() {
    for (std::size_t i = 0; i < body_.points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (body_.points[i].local != body_.points[j].local) continue;
        diagnostics_.add({body_.place,
                          fmt::format("points '{}' and '{}' of {} lie in the same place", point_name(j),
                                      point_name(i), reader_.what()),
                          {},
                          "give them one name"});
      }
    }
  }

  void check_frame() {
    std::vector<std::string> fixed;
    for (std::size_t i = 0; i < body_.points.size(); ++i) {
      if (mechanism_.points[body_.points[i].point].fixed) fixed.push_back(point_name(i));
    }
    if (fixed.size() < 2) return;
    diagnostics_.add({body_.place,
                      fmt::format("{} is held by two points of the frame, '{}' and '{}', and cannot move",
                                  reader_.what(), fixed[0], fixed[1]),
                      "at most one point of the frame in a body",
                      "leave the body out, or name a moving point"});
  }

  const std::string& point_name(std::size_t i) const { return mechanism_.points[body_.points[i].point].name; }

  text::TableReader reader_;
  Mechanism& mechanism_;
  text::Diagnostics& diagnostics_;
  Body body_;
};

}  // namespace

std::optional<Eigen::Vector2d> read_coordinates(const std::string& file, const text::Value& value,
                                                std::string_view unit, const std::string& what,
                                                text::Diagnostics& diagnostics) {
  if (value.kind != text::Value::Kind::array || value.elements.size() != 2) {
    diagnostics.add({{file, value.position}, fmt::format("{} is not a pair of numbers", what), "[x, y]", {}});
    return std::nullopt;
  }
  const auto x = text::read_quantity(file, value.elements[0], unit, "x of " + what, diagnostics);
  const auto y = text::read_quantity(file, value.elements[1], unit, "y of " + what, diagnostics);
  if (!x || !y) return std::nullopt;
  if (!std::isfinite(*x) || !std::isfinite(*y)) {
    diagnostics.add({{file, value.position}, fmt::format("{} is infinite", what), "finite coordinates", {}});
    return std::nullopt;
  }
  if (std::abs(*x) > kLongest || std::abs(*y) > kLongest) {
    diagnostics.add({{file, value.position},
                     fmt::format("{} is at [{}, {}]", what, *x, *y),
                     fmt::format("coordinates up to {}", kLongest),
                     {}});
    return std::nullopt;
  }
  return Eigen::Vector2d(*x, *y);
}

bool check_name(std::string_view kind, const std::string& name, const text::Place& place,
                text::Diagnostics& diagnostics) {
  if (text::is_identifier(name)) return true;
  diagnostics.add({place,
                   fmt::format("'{}' is no name for a {}", name, kind),
                   "letters, digits and _, with no digit in front",
                   {}});
  return false;
}

void read_body(const text::Entry& entry, Mechanism& mechanism, text::Diagnostics& diagnostics) {
  if (!check_name("body", entry.key, {mechanism.file, entry.position}, diagnostics)) return;
  BodyReader(entry, mechanism, diagnostics).read();
}

}  // namespace oblique::mechanism
