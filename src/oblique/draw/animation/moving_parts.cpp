// SPDX-License-Identifier: MIT
#include <oblique/draw/animation/moving_parts.h>

#include <algorithm>
#include <iterator>
#include <numbers>
#include <optional>

#include <oblique/draw/animation/moving_names.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

MovingGroup group_of(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                     const LinkagePart& part, const std::vector<mechanism::Configuration>& frames) {
  using Carrier = LinkagePart::Carrier;
  MovingGroup group{part.marks, {}, part.carrier != Carrier::frame && part.carrier != Carrier::point};
  const bool still = part.carrier == Carrier::frame || part.carrier == Carrier::guide;
  for (const mechanism::Configuration& here : frames) {
    const PartPose pose = pose_of(part, mechanism, here);
    group.placings.push_back({layout.place(pose), -pose.angle * 180 / std::numbers::pi});
    if (still) break;
  }
  return group;
}

MovingGroup group_of(const AnalogShape& shape, const LinkageLayout& layout,
                     const std::vector<std::vector<Vector2d>>& frames) {
  MovingGroup group{{analog_mark(shape, layout.axes, frames.front())}, {}};
  group.closed = shape.closed;
  for (const std::vector<Vector2d>& places : frames) {
    if (shape.points.size() == 1) {
      group.placings.push_back({layout.axes.at(places[shape.points.front()])});
      continue;
    }
    std::vector<Vector2d>& corners = group.corners.emplace_back();
    for (const std::size_t p : shape.points) corners.push_back(layout.axes.at(places[p]));
  }
  if (shape.points.size() == 1) group.marks = {placed(group.marks.front(), -group.placings.front().at, 0)};
  return group;
}

MovingGroup group_of(const MovingName& name, const std::vector<Vector2d>& pins) {
  MovingGroup group{{name.mark}, {}};
  for (std::size_t k = 0; k < pins.size(); ++k) group.placings.push_back({pins[k] + name.offsets[k]});
  const Vector2d first = group.placings.front().at;
  const bool still = std::all_of(group.placings.begin(), group.placings.end(),
                                 [&](const Placing& placing) { return placing.at == first; });
  if (still) group.placings.resize(1);
  return group;
}

/// The leader line of a name, hidden under the pin where the name is beside it; nothing where it always is.
std::optional<MovingGroup> leader_of(const MovingName& name, const std::vector<Vector2d>& pins) {
  MovingGroup group;
  bool strays = false;
  for (std::size_t k = 0; k < pins.size(); ++k) {
    const auto end = leader_end(extent_of(placed(name.mark, pins[k] + name.offsets[k], 0)), pins[k]);
    group.corners.push_back({pins[k], end.value_or(pins[k])});
    strays = strays || end;
  }
  if (!strays) return std::nullopt;
  const std::vector<Vector2d>& first = group.corners.front();
  group.marks.push_back(leader_mark(first.front(), first.back(), std::get<Label>(name.mark.shape).text));
  return group;
}

}  // namespace

std::vector<MovingGroup> moving_groups(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                                       const LinkageAnimation& animation) {
  std::vector<MovingGroup> groups, names;
  const auto add_parts = [&](Layer layer) {
    for (const LinkagePart& part : parts_in(layer, layout.parts))
      groups.push_back(group_of(mechanism, layout, part, animation.frames));
  };
  add_parts(Layer::bodies);
  groups.push_back({layout.paths, {Placing{}}});
  add_parts(Layer::blocks);
  for (const MovingName& name : moving_names(mechanism, layout, animation.frames, animation.analog_frames)) {
    std::vector<Vector2d> pins;
    for (const mechanism::Configuration& here : animation.frames)
      pins.push_back(layout.axes.at(here.points[name.point].position));
    if (auto leader = leader_of(name, pins)) groups.push_back(std::move(*leader));
    names.push_back(group_of(name, pins));
  }
  add_parts(Layer::pins);
  for (const AnalogShape& shape : layout.analog)
    groups.push_back(group_of(shape, layout, animation.analog_frames));
  groups.insert(groups.end(), std::make_move_iterator(names.begin()), std::make_move_iterator(names.end()));
  return groups;
}

std::vector<Mark> marks_in_frame(const MovingGroup& group, std::size_t frame) {
  if (!group.corners.empty()) {
    const Mark& mark = group.marks.front();
    Mark line = polyline_mark(group.corners[group.corners.size() > 1 ? frame : 0], mark.pen, group.closed);
    line.id = mark.id;
    return {line};
  }
  const Placing& placing = group.placings[group.placings.size() > 1 ? frame : 0];
  std::vector<Mark> marks;
  for (const Mark& mark : group.marks)
    marks.push_back(placed(mark, placing.at, -placing.turned * std::numbers::pi / 180));
  return marks;
}

}  // namespace oblique::draw
