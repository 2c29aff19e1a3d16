// SPDX-License-Identifier: MIT
#include <oblique/synthesis/sketch_edit.h>

#include <fmt/format.h>

#include <oblique/text/document.h>
#include <oblique/text/toml_edit.h>

namespace oblique::synthesis {

std::string with_sketch(const std::string& text, const mechanism::Mechanism& mechanism,
                        const std::vector<mechanism::SketchPoint>& points, NewPoints new_points) {
  using Kind = text::TomlChange::Kind;
  const text::Document document = text::parse_document(text, mechanism.file);
  const text::Value* const sketch = document.root.find("sketch");
  std::vector<text::TomlChange> changes;
  for (const mechanism::SketchPoint& sketched : points) {
    const std::string& name = mechanism.points[sketched.point].name;
    const std::string x = fmt::format("{:.6g}", sketched.position.x());
    const std::string y = fmt::format("{:.6g}", sketched.position.y());
    if (sketch != nullptr && sketch->find(name) != nullptr) {
      changes.push_back({Kind::set, {"sketch", name, std::size_t{0}}, x});
      changes.push_back({Kind::set, {"sketch", name, std::size_t{1}}, y});
    } else if (new_points == NewPoints::add) {
      changes.push_back({Kind::set, {"sketch", name}, fmt::format("[{}, {}]", x, y)});
    }
  }
  return text::edit_toml(text, mechanism.file, changes);
}

}  // namespace oblique::synthesis
