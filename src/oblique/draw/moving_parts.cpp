// SPDX-License-Identifier: MIT
#include <oblique/draw/moving_parts.h>

#include <algorithm>
#include <numbers>

#include <oblique/draw/moving_names.h>

namespace oblique {
namespace {

using Eigen::Vector2d;

MovingGroup group_of(const Mechanism& mechanism, const LinkageLayout& layout, const LinkagePart& part,
                     const std::vector<Configuration>& frames) {
  using Carrier = LinkagePart::Carrier;
  MovingGroup group{part.marks, {}, part.carrier != Carrier::frame && part.carrier != Carrier::point};
  const bool still = part.carrier == Carrier::frame || part.carrier == Carrier::guide;
  for (const Configuration& here : frames) {
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

void add_names(std::vector<MovingGroup>& groups, const Mechanism& mechanism, const LinkageLayout& layout,
               const LinkageAnimation& animation) {
  for (const MovingName& name : moving_names(mechanism, layout, animation.frames, animation.analog_frames)) {
    MovingGroup group{{name.mark}, {}};
    for (std::size_t k = 0; k < animation.frames.size(); ++k) {
      const Vector2d pin = layout.axes.at(animation.frames[k].points[name.point].position);
      group.placings.push_back({pin + name.offsets[k]});
    }
    const Vector2d first = group.placings.front().at;
    const bool still = std::all_of(group.placings.begin(), group.placings.end(),
                                   [&](const Placing& placing) { return placing.at == first; });
    if (still) group.placings.resize(1);
    groups.push_back(std::move(group));
  }
}

}  // namespace

std::vector<MovingGroup> moving_groups(const Mechanism& mechanism, const LinkageLayout& layout,
                                       const LinkageAnimation& animation) {
  std::vector<MovingGroup> groups;
  bool paths_drawn = false;
  for (const LinkagePart& part : layout.parts) {
    if (!paths_drawn && lies_over_paths(part)) {
      groups.push_back({layout.paths, {Placing{}}});
      paths_drawn = true;
    }
    groups.push_back(group_of(mechanism, layout, part, animation.frames));
  }
  for (const AnalogShape& shape : layout.analog)
    groups.push_back(group_of(shape, layout, animation.analog_frames));
  add_names(groups, mechanism, layout, animation);
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

}  // namespace oblique
