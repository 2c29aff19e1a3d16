// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/drive_reader.h>

#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/model/body_reader.h>
#include <oblique/mechanism/model/drive_law.h>
#include <oblique/text/table_reader.h>

namespace oblique::mechanism {
namespace {

class DriveReader {
 public:
  DriveReader(const text::Entry& entry, Mechanism& mechanism, text::Diagnostics& diagnostics)
      : reader_(mechanism.file, entry.value, fmt::format("drive '{}'", entry.key), diagnostics),
        mechanism_(mechanism),
        diagnostics_(diagnostics) {
    drive_.name = entry.key;
    drive_.place = reader_.place(entry.position);
  }

  void read() {
    if (reader_.table().kind != text::Value::Kind::table) return;  // reported by the reader
    const auto slides = reader_.string("slides");
    bool good = false;
    if (slides) {
      if (reader_.find("turns") != nullptr || reader_.find("about") != nullptr) {
        reader_.report("slides", fmt::format("{} turns a body and moves a slide", reader_.what()),
                       "either turns and about, or slides");
      }
      good = find_slide(*slides);
    } else {
      good = find_body();
    }
    read_speed(slides ? mechanism_.length_unit + "/s" : "rad/s");
    const auto start = reader_.quantity("start", slides ? mechanism_.length_unit : "rad");
    reader_.finish();
    if (start && !std::isfinite(*start)) {
      reader_.report("start", fmt::format("{} starts at {}", reader_.what(), *start),
                     slides ? "a finite distance" : "a finite angle");
    }
    drive_.start = start.value_or(0);
    if (good) mechanism_.drives.push_back(std::move(drive_));
  }

 private:
  bool find_slide(const std::string& name) {
    const auto slide = mechanism_.find_slide(name);
    if (!slide) {
      reader_.report("slides", fmt::format("{} moves '{}', which is no slide", reader_.what(), name), {},
                     text::suggest(name, names_of(mechanism_.slides)));
      return false;
    }
    for (const Drive& other : mechanism_.drives) {
      if (other.slide != slide) continue;
      reader_.report("slides", fmt::format("slide '{}' is moved by drive '{}' already", name, other.name),
                     "one drive for a slide");
      return false;
    }
    drive_.slide = slide;
    return true;
  }

  bool find_body() {
    const auto turns =
        reader_.required_string("turns", "turns = the name of a body, or slides = that of a slide");
    const auto about = reader_.required_string("about", "about = the point the body turns about");
    if (!turns || !about) return false;
    const auto body = mechanism_.find_body(*turns);
    if (!body) {
      reader_.report("turns", fmt::format("{} turns '{}', which is no body", reader_.what(), *turns), {},
                     text::suggest(*turns, names_of(mechanism_.bodies)));
      return false;
    }
    const auto point = mechanism_.find_point(*about);
    if (!point || mechanism_.bodies[*body].find(*point) == nullptr) {
      std::vector<std::string> names;
      for (const BodyPoint& p : mechanism_.bodies[*body].points)
        names.push_back(mechanism_.points[p.point].name);
      reader_.report(
          "about",
          fmt::format("{} turns about '{}', which is no point of body '{}'", reader_.what(), *about, *turns),
          {}, text::suggest(*about, names));
      return false;
    }
    if (const auto other = mechanism_.drive_of(*body)) {
      reader_.report(
          "turns",
          fmt::format("body '{}' is turned by drive '{}' already", *turns, mechanism_.drives[*other].name),
          "one drive for a body");
      return false;
    }
    drive_.body = *body;
    drive_.about = *point;
    return true;
  }

  /// A quantity, or a law: an expression of `time` with an optional unit.
  void read_speed(const std::string& unit) {
    drive_.speed = 1;  // keeps the other findings sensible
    const text::Value* const value = reader_.find("speed");
    if (value != nullptr && value->kind == text::Value::Kind::string) {
      try {
        if (auto law = parse_law(value->text, text::parse_unit(unit).value())) {
          drive_.law = std::move(law->speed);
          drive_.law_scale = law->scale;
          drive_.speed = law_at(drive_, 0).rate;
          constexpr double kSoonAfter = 1e-6;  // s
          constexpr double kRest = 1e-9;       // of the law's unit: cos(pi/2) is not quite 0
          if (!std::isfinite(drive_.speed)) {
            reader_.report("speed", fmt::format("{} has speed {} at t = 0", reader_.what(), drive_.speed),
                           "a speed that is finite where the motion starts");
            drive_.speed = 1;
          } else if (std::abs(drive_.speed) < kRest * std::abs(drive_.law_scale)) {
            drive_.speed = std::copysign(drive_.law_scale, law_at(drive_, kSoonAfter).rate);
          }
          return;
        }
      } catch (const text::ExpressionError& error) {
        diagnostics_.add(
            text::to_diagnostic(error, mechanism_.file, *value, fmt::format("speed of {}", reader_.what())));
        return;
      }
    }
    const auto speed = reader_.required_quantity("speed", unit);
    if (speed && *speed == 0) {
      reader_.report(
          "speed",
          fmt::format("{} has speed zero and never {}", reader_.what(), drive_.slide ? "moves" : "turns"),
          "a speed other than 0");
    } else if (speed && !std::isfinite(*speed)) {
      reader_.report("speed", fmt::format("{} has speed {}", reader_.what(), *speed), "a finite speed");
    }
    drive_.speed = speed.value_or(1);
  }

  text::TableReader reader_;
  Mechanism& mechanism_;
  text::Diagnostics& diagnostics_;
  Drive drive_;
};

}  // namespace

void read_drive(const text::Entry& entry, Mechanism& mechanism, text::Diagnostics& diagnostics) {
  if (!check_name("drive", entry.key, {mechanism.file, entry.position}, diagnostics)) return;
  DriveReader(entry, mechanism, diagnostics).read();
}

}  // namespace oblique::mechanism
