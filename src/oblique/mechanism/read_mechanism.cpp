// SPDX-License-Identifier: MIT
#include <oblique/mechanism/read_mechanism.h>

#include <array>
#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/body_reader.h>
#include <oblique/text/document.h>
#include <oblique/text/quantity.h>
#include <oblique/text/table_reader.h>

namespace oblique {
namespace {

template <class Items>
std::vector<std::string> names_of(const Items& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

class MechanismReader {
 public:
  explicit MechanismReader(const Document& document)
      : reader_(document.file, document.root, "the mechanism", diagnostics_) {
    mechanism_.file = document.file;
  }

  Mechanism read() {
    check_format(reader_, "oblique-mechanism/1");
    mechanism_.title = reader_.string("title").value_or("");
    mechanism_.source = reader_.string("source").value_or("");
    read_units();
    read_frame();
    read_bodies();
    read_slides();
    read_drives();
    read_sketch();
    reader_.finish();
    check_names();
    check_shared_points();
    diagnostics_.throw_if_any<MechanismError>();
    return std::move(mechanism_);
  }

 private:
  void read_units() {
    const Value* const table = reader_.table("units");
    if (table == nullptr) return;
    TableReader units(mechanism_.file, *table, "[units]", diagnostics_);
    const auto length = units.string("length");
    units.finish();
    if (!length) return;
    const auto unit = parse_unit(*length);
    if (unit && unit->same_dimension(parse_unit("m").value())) {
      mechanism_.length_unit = *length;
    } else {
      units.report("length", fmt::format("'{}' is no unit of length", *length), R"("m", "mm", "cm" …)",
                   suggest(*length, {"m", "dm", "cm", "mm", "um", "km", "in", "ft"}));
    }
  }

  void read_frame() {
    const Value* const frame = reader_.table("frame");
    if (frame == nullptr || frame->entries.empty()) {
      reader_.report("frame", "the mechanism has no point fixed in the frame", "[frame] with A = [x, y]");
      return;
    }
    for (const Entry& entry : frame->entries) {
      if (!check_name("point", entry.key, reader_.place(entry.position), diagnostics_)) continue;
      const auto position = read_coordinates(mechanism_.file, entry.value, mechanism_.length_unit,
                                             fmt::format("frame point '{}'", entry.key), diagnostics_);
      mechanism_.points.push_back({entry.key, true, position.value_or(Eigen::Vector2d::Zero())});
    }
  }

  void read_bodies() {
    const Value* const bodies = reader_.table("bodies");
    if (bodies == nullptr || bodies->entries.empty()) {
      reader_.report("bodies", "the mechanism has no bodies",
                     R"([bodies] with AB = { points = ["A", "B"], length = 1 })");
      return;
    }
    for (const Entry& entry : bodies->entries) read_body(entry, mechanism_, diagnostics_);
  }

  void read_slides() {
    const Value* const slides = reader_.table("slides");
    if (slides == nullptr) return;
    has_slides_ = true;
    report_slides(slides->position, "[slides] cannot be solved");
  }

  void report_slides(SourcePosition position, const std::string& what) {
    diagnostics_.add({reader_.place(position), what + ": slides are not handled by this version",
                      "bodies joined by hinges only",
                      "replace a slide by a long bar where that is near enough"});
  }

  void read_drives() {
    const Value* const drives = reader_.table("drives");
    if (drives == nullptr) return;
    for (const Entry& entry : drives->entries) {
      if (check_name("drive", entry.key, reader_.place(entry.position), diagnostics_)) read_drive(entry);
    }
  }

  void read_drive(const Entry& entry) {
    TableReader reader(mechanism_.file, entry.value, fmt::format("drive '{}'", entry.key), diagnostics_);
    if (entry.value.kind != Value::Kind::table) return;  // reported by the reader
    if (entry.value.find("slides") != nullptr) {
      if (!has_slides_) report_slides(entry.position, reader.what() + " moves a slide");
      return;
    }
    const auto turns = reader.required_string("turns", "turns = the name of a body");
    const auto about = reader.required_string("about", "about = the point the body turns about");
    const auto speed = reader.required_quantity("speed", "rad/s");
    const auto start = reader.quantity("start", "rad");
    reader.finish();
    if (speed && *speed == 0) {
      reader.report("speed", fmt::format("{} has speed zero and never turns", reader.what()),
                    "a speed other than 0");
    } else if (speed && !std::isfinite(*speed)) {
      reader.report("speed", fmt::format("{} has speed {}", reader.what(), *speed), "a finite speed");
    }
    if (start && !std::isfinite(*start)) {
      reader.report("start", fmt::format("{} starts at {}", reader.what(), *start), "a finite angle");
    }
    if (!turns || !about) return;
    const auto body = mechanism_.find_body(*turns);
    if (!body) {
      reader.report("turns", fmt::format("{} turns '{}', which is no body", reader.what(), *turns), {},
                    suggest(*turns, names_of(mechanism_.bodies)));
      return;
    }
    const auto point = mechanism_.find_point(*about);
    if (!point || mechanism_.bodies[*body].find(*point) == nullptr) {
      std::vector<std::string> names;
      for (const BodyPoint& p : mechanism_.bodies[*body].points)
        names.push_back(mechanism_.points[p.point].name);
      reader.report(
          "about",
          fmt::format("{} turns about '{}', which is no point of body '{}'", reader.what(), *about, *turns),
          {}, suggest(*about, names));
      return;
    }
    if (const auto other = mechanism_.drive_of(*body)) {
      reader.report(
          "turns",
          fmt::format("body '{}' is turned by drive '{}' already", *turns, mechanism_.drives[*other].name),
          "one drive for a body");
      return;
    }
    mechanism_.drives.push_back(
        {entry.key, *body, *point, speed.value_or(1), start.value_or(0), reader.place(entry.position)});
  }

  void read_sketch() {
    const Value* const sketch = reader_.table("sketch");
    if (sketch == nullptr) return;
    for (const Entry& entry : sketch->entries) {
      const auto position = read_coordinates(mechanism_.file, entry.value, mechanism_.length_unit,
                                             fmt::format("sketched point '{}'", entry.key), diagnostics_);
      const auto point = mechanism_.find_point(entry.key);
      if (!point) {
        diagnostics_.add({reader_.place(entry.position),
                          fmt::format("[sketch] places '{}', which is no point", entry.key),
                          "a point of a body", suggest(entry.key, names_of(mechanism_.points))});
      } else if (position) {
        mechanism_.sketch.push_back({*point, *position});
      }
    }
  }

  /// A name means one thing: the columns of a motion and the blocks of a patch carry these names.
  void check_names() {
    for (const Body& body : mechanism_.bodies) {
      if (mechanism_.find_point(body.name)) {
        diagnostics_.add({body.place,
                          fmt::format("'{}' is the name of a body and of a point", body.name),
                          {},
                          "rename one of them"});
      }
    }
    for (const Drive& drive : mechanism_.drives) {
      if (mechanism_.find_point(drive.name)) {
        diagnostics_.add({drive.place,
                          fmt::format("'{}' is the name of a drive and of a point", drive.name),
                          {},
                          "rename one of them"});
      }
      if (drive.name == "t" || drive.name == "status") {
        diagnostics_.add(
            {drive.place,
             fmt::format("a drive cannot be called '{}': a column of the motion has that name", drive.name),
             {},
             "rename the drive"});
      }
    }
  }

  void check_shared_points() {
    const auto& bodies = mechanism_.bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        std::vector<std::string> shared;
        for (const BodyPoint& p : bodies[i].points) {
          if (bodies[j].find(p.point) != nullptr) shared.push_back(mechanism_.points[p.point].name);
        }
        if (shared.size() < 2) continue;
        diagnostics_.add({bodies[i].place,
                          fmt::format("bodies '{}' and '{}' share the points '{}' and '{}', so they cannot "
                                      "move against each other",
                                      bodies[j].name, bodies[i].name, shared[0], shared[1]),
                          "at most one common point", "make them one body, with marks for the other points"});
      }
    }
  }

  Diagnostics diagnostics_;
  TableReader reader_;
  Mechanism mechanism_;
  bool has_slides_ = false;
};

}  // namespace

Mechanism parse_mechanism(std::string_view text, std::string file) {
  const Document document = parse_document(text, std::move(file));
  return MechanismReader(document).read();
}

Mechanism read_mechanism(const std::filesystem::path& path) {
  return parse_mechanism(read_file(path), path.string());
}

}  // namespace oblique
