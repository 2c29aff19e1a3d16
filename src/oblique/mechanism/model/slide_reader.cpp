// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/slide_reader.h>

#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/model/body_reader.h>
#include <oblique/text/table_reader.h>

namespace oblique::mechanism {
namespace {

class SlideReader {
 public:
  SlideReader(const text::Entry& entry, Mechanism& mechanism, text::Diagnostics& diagnostics)
      : reader_(mechanism.file, entry.value, fmt::format("slide '{}'", entry.key), diagnostics),
        mechanism_(mechanism) {
    slide_.name = entry.key;
    slide_.place = reader_.place(entry.position);
  }

  void read() {
    if (reader_.table().kind != text::Value::Kind::table) return;  // reported by the reader
    const auto point = named_point();
    const bool has_line = read_line();
    slide_.offset = finite("offset", mechanism_.length_unit).value_or(0);
    const auto angle = finite("angle", "rad");
    const auto of = reader_.string("of");
    reader_.finish();
    if (!point || !has_line || !check_point(*point)) return;
    slide_.point = *point;
    if (angle) {
      slide_.angle = *angle;
      slide_.of = guided_body(of);
      if (!slide_.of) return;
    } else if (of) {
      reader_.report("of", fmt::format("{} names a body and no 'angle'", reader_.what()),
                     fmt::format(R"(angle = the angle of '{}' to the line, as "90 deg")", *of),
                     "leave 'of' out where the body may turn");
      return;
    }
    mechanism_.slides.push_back(std::move(slide_));
  }

 private:
  std::optional<double> finite(const std::string& key, std::string_view unit) {
    const auto value = reader_.quantity(key, unit);
    if (!value || std::isfinite(*value)) return value;
    reader_.report(key, fmt::format("'{}' of {} is {}", key, reader_.what(), *value), "a finite number");
    return std::nullopt;
  }

  std::optional<std::size_t> named_point() {
    const auto name = reader_.required_string("point", "point = the point that slides");
    if (!name) return std::nullopt;
    const auto point = mechanism_.find_point(*name);
    if (!point) {
      reader_.report("point", fmt::format("{} moves '{}', which is no point", reader_.what(), *name), {},
                     text::suggest(*name, names_of(mechanism_.points)));
    }
    return point;
  }

  /// first, second and carrier; false after a finding.
  bool read_line() {
    constexpr auto kExpected = R"(along = ["P", "Q"]: two points of one body or of the frame)";
    const auto names = reader_.strings("along");
    if (!names || names->size() != 2 || (*names)[0] == (*names)[1]) {
      if (names || reader_.table().find("along") == nullptr) {
        reader_.report("along", fmt::format("{} has no line of two points", reader_.what()), kExpected);
      }
      return false;
    }
    std::optional<std::size_t> ends[2];
    for (std::size_t i = 0; i < 2; ++i) {
      ends[i] = mechanism_.find_point((*names)[i]);
      if (ends[i]) continue;
      reader_.report("along",
                     fmt::format("{} slides along '{}', which is no point", reader_.what(), (*names)[i]), {},
                     text::suggest((*names)[i], names_of(mechanism_.points)));
      return false;
    }
    slide_.first = *ends[0];
    slide_.second = *ends[1];
    if (mechanism_.points[slide_.first].fixed && mechanism_.points[slide_.second].fixed) {
      if (mechanism_.points[slide_.first].position != mechanism_.points[slide_.second].position) return true;
      reader_.report(
          "along",
          fmt::format("'{}' and '{}' lie in the same place and give no line", (*names)[0], (*names)[1]),
          "two points apart");
      return false;
    }
    for (const std::size_t body : mechanism_.bodies_at(slide_.first)) {
      if (mechanism_.bodies[body].find(slide_.second) != nullptr) slide_.carrier = body;
    }
    if (slide_.carrier) return true;
    reader_.report(
        "along",
        fmt::format("no body has both '{}' and '{}', so they give no line", (*names)[0], (*names)[1]),
        kExpected);
    return false;
  }

  bool check_point(std::size_t point) {
    const std::string& name = mechanism_.points[point].name;
    if (slide_.carrier && mechanism_.bodies[*slide_.carrier].find(point) != nullptr) {
      reader_.report("point",
                     fmt::format("'{}' is a point of '{}', which carries the line, and cannot slide on it",
                                 name, mechanism_.bodies[*slide_.carrier].name),
                     "a point of another body or of the frame");
      return false;
    }
    if (!slide_.carrier && mechanism_.points[point].fixed) {
      reader_.report("point", fmt::format("'{}' and the line are both fixed in the frame", name),
                     "a point of a body");
      return false;
    }
    return true;
  }

  /// The body that keeps the angle; nothing after a finding.
  std::optional<std::size_t> guided_body(const std::optional<std::string>& name) {
    const std::string& point = mechanism_.points[slide_.point].name;
    if (name) {
      const auto body = mechanism_.find_body(*name);
      if (!body || mechanism_.bodies[*body].find(slide_.point) == nullptr) {
        std::vector<std::string> owners;
        for (const std::size_t owner : mechanism_.bodies_at(slide_.point))
          owners.push_back(mechanism_.bodies[owner].name);
        reader_.report(
            "of",
            fmt::format("{} guides '{}', which is no body with the point '{}'", reader_.what(), *name, point),
            {}, text::suggest(*name, owners));
        return std::nullopt;
      }
      return body;
    }
    const auto owners = mechanism_.bodies_at(slide_.point);
    if (owners.size() == 1 && !mechanism_.points[slide_.point].fixed) return owners.front();
    reader_.report("angle",
                   fmt::format("{} has an angle, and {} the point '{}'", reader_.what(),
                               owners.empty() ? "no body has" : "not one body alone has", point),
                   "of = the body that keeps the angle",
                   owners.empty() ? "let the point be one of the body that slides" : "");
    return std::nullopt;
  }

  text::TableReader reader_;
  Mechanism& mechanism_;
  Slide slide_;
};

}  // namespace

void read_slide(const text::Entry& entry, Mechanism& mechanism, text::Diagnostics& diagnostics) {
  if (!check_name("slide", entry.key, {mechanism.file, entry.position}, diagnostics)) return;
  SlideReader(entry, mechanism, diagnostics).read();
}

}  // namespace oblique::mechanism
