// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/read_mechanism.h>

#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <oblique/mechanism/model/body_reader.h>
#include <oblique/mechanism/model/drive_reader.h>
#include <oblique/mechanism/model/expectation.h>
#include <oblique/mechanism/model/slide_reader.h>
#include <oblique/text/document.h>
#include <oblique/text/file.h>
#include <oblique/text/quantity.h>
#include <oblique/text/table_reader.h>

namespace oblique::mechanism {
namespace {

class MechanismReader {
 public:
  explicit MechanismReader(const text::Document& document)
      : reader_(document.file, document.root, "the mechanism", diagnostics_) {
    mechanism_.file = document.file;
  }

  Mechanism read() {
    if (!text::check_format(reader_, "oblique-mechanism/1")) diagnostics_.throw_if_any<MechanismError>();
    mechanism_.title = reader_.string("title").value_or("");
    mechanism_.source = reader_.string("source").value_or("");
    read_units();
    read_frame();
    read_bodies();
    read_slides();
    read_drives();
    read_sketch();
    read_motion();
    if (const text::Value* const expect = reader_.table("expect")) {
      read_mechanism_expectations(*expect, mechanism_, diagnostics_);
    }
    reader_.finish();
    check_names();
    check_shared_points();
    diagnostics_.throw_if_any<MechanismError>();
    return std::move(mechanism_);
  }

 private:
  void read_units() {
    const text::Value* const table = reader_.table("units");
    if (table == nullptr) return;
    text::TableReader units(mechanism_.file, *table, "[units]", diagnostics_);
    const auto length = units.string("length");
    units.finish();
    if (!length) return;
    const auto unit = text::parse_unit(*length);
    if (unit && unit->same_dimension(text::parse_unit("m").value())) {
      mechanism_.length_unit = *length;
    } else {
      units.report("length", fmt::format("'{}' is no unit of length", *length), R"("m", "mm", "cm" …)",
                   text::suggest(*length, {"m", "dm", "cm", "mm", "um", "km", "in", "ft"}));
    }
  }

  void read_frame() {
    const text::Value* const frame = reader_.table("frame");
    if (frame == nullptr || frame->entries.empty()) {
      reader_.report("frame", "the mechanism has no point fixed in the frame", "[frame] with A = [x, y]");
      return;
    }
    for (const text::Entry& entry : frame->entries) {
      if (!check_name("point", entry.key, reader_.place(entry.position), diagnostics_)) continue;
      const auto position = read_coordinates(mechanism_.file, entry.value, mechanism_.length_unit,
                                             fmt::format("frame point '{}'", entry.key), diagnostics_);
      mechanism_.points.push_back({entry.key, true, position.value_or(Eigen::Vector2d::Zero())});
    }
  }

  void read_bodies() {
    const text::Value* const bodies = reader_.table("bodies");
    if (bodies == nullptr || bodies->entries.empty()) {
      reader_.report("bodies", "the mechanism has no bodies",
                     R"([bodies] with AB = { points = ["A", "B"], length = 1 })");
      return;
    }
    for (const text::Entry& entry : bodies->entries) read_body(entry, mechanism_, diagnostics_);
  }

  void read_slides() {
    const text::Value* const slides = reader_.table("slides");
    if (slides == nullptr) return;
    for (const text::Entry& entry : slides->entries) read_slide(entry, mechanism_, diagnostics_);
  }

  void read_drives() {
    const text::Value* const drives = reader_.table("drives");
    if (drives == nullptr) return;
    for (const text::Entry& entry : drives->entries) read_drive(entry, mechanism_, diagnostics_);
  }

  void read_sketch() {
    const text::Value* const sketch = reader_.table("sketch");
    if (sketch == nullptr) return;
    for (const text::Entry& entry : sketch->entries) {
      const auto position = read_coordinates(mechanism_.file, entry.value, mechanism_.length_unit,
                                             fmt::format("sketched point '{}'", entry.key), diagnostics_);
      const auto point = mechanism_.find_point(entry.key);
      if (!point) {
        diagnostics_.add({reader_.place(entry.position),
                          fmt::format("[sketch] places '{}', which is no point", entry.key),
                          "a point of a body", text::suggest(entry.key, names_of(mechanism_.points))});
      } else if (position) {
        mechanism_.sketch.push_back({*point, *position});
      }
    }
  }

  void read_motion() {
    const text::Value* const table = reader_.table("motion");
    if (table == nullptr) return;
    text::TableReader motion(mechanism_.file, *table, "[motion]", diagnostics_);
    const auto until = motion.quantity("until", "s");
    const auto at_limit = motion.string("at_limit");
    motion.finish();
    if (until && !(*until > 0 && std::isfinite(*until))) {
      motion.report("until", fmt::format("'until' of [motion] is {}", *until), "a finite time above 0 [s]");
    } else {
      mechanism_.motion.until = until;
    }
    if (at_limit) mechanism_.motion.at_limit = parse_at_limit(*at_limit);
    if (at_limit && !mechanism_.motion.at_limit) {
      motion.report("at_limit", fmt::format("'at_limit' of [motion] is \"{}\"", *at_limit),
                    R"("open", "stop" or "reverse")");
    }
  }

  /// A name means one thing: the columns of a motion and the blocks of a patch carry these names.
  void check_names() {
    std::vector<std::pair<std::string_view, std::string>> seen;  // kind and name
    for (const Point& point : mechanism_.points) seen.emplace_back("point", point.name);
    const auto check = [&](std::string_view kind, const std::string& name, const text::Place& place) {
      for (const auto& [other_kind, other] : seen) {
        if (other != name || other_kind == kind) continue;
        // a drive may have the name of the body that it turns
        if (kind == "drive" && other_kind == "body") continue;
        diagnostics_.add({place,
                          fmt::format("'{}' is the name of a {} and of a {}", name, kind, other_kind),
                          {},
                          "rename one of them"});
      }
      seen.emplace_back(kind, name);
    };
    for (const Body& body : mechanism_.bodies) check("body", body.name, body.place);
    for (const Slide& slide : mechanism_.slides) check("slide", slide.name, slide.place);
    for (const Drive& drive : mechanism_.drives) {
      check("drive", drive.name, drive.place);
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

  text::Diagnostics diagnostics_;
  text::TableReader reader_;
  Mechanism mechanism_;
};

}  // namespace

Mechanism parse_mechanism(std::string_view text, std::string file) {
  const text::Document document = text::parse_document(text, std::move(file));
  return MechanismReader(document).read();
}

Mechanism read_mechanism(const std::filesystem::path& path) {
  return parse_mechanism(text::read_file(path), path.string());
}

}  // namespace oblique::mechanism
