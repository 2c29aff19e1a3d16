// SPDX-License-Identifier: MIT
#include <oblique/draw/linkage/linkage_layout.h>

#include <algorithm>

#include <oblique/draw/animation/analog_overlay.h>
#include <oblique/draw/linkage/linkage_head.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr double kWidth = 760, kMargin = 16;     // [px]
constexpr double kWidest = 690, kTallest = 560;  // of what is drawn [px]
constexpr double kLeast = 200;                   // height of the frame [px]
constexpr double kRoomForNames = 26;             // around what is drawn [px]

/// All positions that have to be seen; a few of the motion's are enough between those.
std::vector<mechanism::Configuration> samples_of(const LinkageScene& scene) {
  constexpr std::size_t kMost = 72;
  std::vector<mechanism::Configuration> samples{scene.shown};
  const std::size_t stride = scene.motion.size() / kMost + 1;
  for (std::size_t k = 0; k < scene.motion.size(); k += stride) samples.push_back(scene.motion[k]);
  samples.insert(samples.end(), scene.others.begin(), scene.others.end());
  std::erase_if(samples,
                [](const mechanism::Configuration& here) { return here.status == mechanism::Status::open; });
  return samples;
}

/// The rectangle that the drawn points cover [length unit].
Extent extent_of_points(const mechanism::Mechanism& mechanism, const LinkageScene& scene) {
  Extent extent;
  const auto add = [&](const mechanism::Configuration& here) {
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      if (is_drawn(mechanism, p) && here.points[p].position.allFinite())
        extent.extend(here.points[p].position);
    }
  };
  add(scene.shown);
  for (const mechanism::Configuration& here : scene.motion) add(here);
  if (!scene.analog) return extent;
  const auto add_analog = [&](const std::vector<Vector2d>& places) {
    for (std::size_t p = 0; p < places.size(); ++p) {
      if (is_drawn(mechanism, p) && places[p].allFinite()) extent.extend(places[p]);
    }
  };
  add_analog(scene.analog->shown);
  for (const auto& places : scene.analog->motion) add_analog(places);
  return extent;
}

/// The largest scale at which a rectangle and `room` [px] on all sides fit [px/length unit].
double fitting_scale(const Vector2d& size, const Vector2d& room) {
  const double x = size.x() > 0 ? (kWidest - room.x()) / size.x() : INFINITY;
  const double y = size.y() > 0 ? (kTallest - room.y()) / size.y() : INFINITY;
  return std::isfinite(std::min(x, y)) ? std::min(x, y) : 1;
}

/// What the parts and the points cover in all positions, in pixels from the origin of the data.
Extent covered_by(const mechanism::Mechanism& mechanism, const Extent& points,
                  const std::vector<LinkagePart>& parts, const std::vector<mechanism::Configuration>& samples,
                  double scale) {
  Extent extent;
  if (!points.isEmpty()) {
    extent.extend(Vector2d(points.min().x(), -points.min().y()) * scale);
    extent.extend(Vector2d(points.max().x(), -points.max().y()) * scale);
  }
  for (const mechanism::Configuration& here : samples) {
    for (const LinkagePart& part : parts) {
      const PartPose pose = pose_of(part, mechanism, here);
      const Vector2d at(pose.at.x() * scale, -pose.at.y() * scale);
      for (const Mark& mark : part.marks) extent.extend(extent_of(placed(mark, at, pose.angle)));
    }
  }
  return extent;
}

}  // namespace

LinkageLayout lay_out(const mechanism::Mechanism& mechanism, const LinkageScene& scene) {
  const std::vector<mechanism::Configuration> samples = samples_of(scene);
  const Extent points = extent_of_points(mechanism, scene);
  const Vector2d size = points.isEmpty() ? Vector2d(0, 0) : Vector2d(points.sizes());
  // What surrounds the points is as large as it is at any scale: measured at one, allowed for at the next.
  double scale = fitting_scale(size, Vector2d::Constant(2 * kRoomForNames));
  Extent covered = covered_by(mechanism, points, linkage_parts(mechanism, samples, scale), samples, scale);
  const Vector2d room = (covered.sizes() - size * scale).cwiseMax(0) + Vector2d::Constant(2 * kRoomForNames);
  scale = fitting_scale(size, room);
  covered = covered_by(mechanism, points, linkage_parts(mechanism, samples, scale), samples, scale);

  Picture background;
  background.width = kWidth;
  background.title = mechanism.title;
  const double head = add_linkage_head(background, mechanism, scene);
  const Vector2d margin = Vector2d::Constant(kRoomForNames);
  const Vector2d low = (covered.min() - margin) / scale, high = (covered.max() + margin) / scale;
  const double height = std::clamp((high - low).y() * scale, kLeast, kTallest);
  constexpr double kAroundFrame = 72;  // numbers and titles of the axes
  background.height = std::ceil(head + height + kAroundFrame + kMargin);
  const Extent place(Vector2d(kMargin - 4, head + 6), Vector2d(kWidth - 4, background.height - 12));
  const Axes axes =
      Axes::within(place, Scale({"x", mechanism.length_unit}, {low.x(), high.x()}, false),
                   Scale({"y", mechanism.length_unit}, {-high.y(), -low.y()}, false), Axes::Shape::equal);
  for (Mark& mark : axes.marks()) background.marks.push_back(std::move(mark));
  LinkageLayout layout{
      std::move(background), axes, linkage_parts(mechanism, samples, axes.scale().x()), {}, {}};
  for (std::size_t k = 0; k < scene.traces.size(); ++k) {
    std::vector<Vector2d> path;
    for (const mechanism::Configuration& here : scene.motion)
      path.push_back(here.points[scene.traces[k]].position);
    layout.paths.push_back(curve_mark(axes, path, trace_pen(scene, k)));
    layout.paths.back().id = "path-" + mechanism.points[scene.traces[k]].name;
    if (!scene.analog) continue;
    path.clear();
    for (const auto& places : scene.analog->motion) path.push_back(places[scene.traces[k]]);
    layout.paths.push_back(curve_mark(axes, path, analog_trace_pen(k)));
    layout.paths.back().id = "analog-path-" + mechanism.points[scene.traces[k]].name;
  }
  if (scene.analog) layout.analog = analog_shapes(mechanism);
  return layout;
}

LabelPlacer placer_among(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                         const mechanism::Configuration& here, const std::vector<Vector2d>& analog) {
  constexpr double kOfPath = 8, kOfAnalog = 20,
                   kOfPart = 50;  // a name may rather lie on a path than on a link
  LabelPlacer placer(layout.axes.frame());
  for (const Mark& path : layout.paths) placer.avoid(path, kOfPath);
  for (const LinkagePart& part : layout.parts) {
    const PartPose pose = pose_of(part, mechanism, here);
    for (const Mark& mark : part.marks) {
      const Mark drawn = placed(mark, layout.place(pose), pose.angle);
      placer.avoid(drawn, kOfPart);
      if (part.carrier == LinkagePart::Carrier::point) placer.add_pin(drawn);
    }
  }
  if (analog.empty()) return placer;
  for (const AnalogShape& shape : layout.analog)
    placer.avoid(analog_mark(shape, layout.axes, analog), kOfAnalog);
  return placer;
}

NameMarks name_marks(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                     const mechanism::Configuration& here, const std::vector<Vector2d>& analog) {
  LabelPlacer placer = placer_among(mechanism, layout, here, analog);
  NameMarks marks;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (!is_drawn(mechanism, p)) continue;
    const std::string& name = mechanism.points[p].name;
    const Vector2d pin = layout.axes.at(here.points[p].position);
    marks.names.push_back(placer.place(pin, name, kNameSize));
    marks.names.back().id = "name-" + name;
    if (const auto end = leader_end(extent_of(marks.names.back()), pin))
      marks.leaders.push_back(leader_mark(pin, *end, name));
  }
  return marks;
}

}  // namespace oblique::draw
