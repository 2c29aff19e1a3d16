// SPDX-License-Identifier: MIT
#include <oblique/draw/linkage_layout.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/draw/label_placer.h>

namespace oblique {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr double kWidth = 760, kMargin = 16;      // [px]
constexpr double kWidest = 690, kTallest = 560;   // of what is drawn [px]
constexpr double kLeast = 200;                    // height of the frame [px]
constexpr double kRoomForNames = 26;              // around what is drawn [px]
constexpr double kNameSize = 13, kTextSize = 12;  // [px]

/// All positions that have to be seen; a few of the motion's are enough between those.
std::vector<Configuration> samples_of(const LinkageScene& scene) {
  constexpr std::size_t kMost = 72;
  std::vector<Configuration> samples{scene.shown};
  const std::size_t stride = scene.motion.size() / kMost + 1;
  for (std::size_t k = 0; k < scene.motion.size(); k += stride) samples.push_back(scene.motion[k]);
  samples.insert(samples.end(), scene.others.begin(), scene.others.end());
  std::erase_if(samples, [](const Configuration& here) { return here.status == Status::open; });
  return samples;
}

/// The rectangle that the drawn points cover [length unit].
Extent extent_of_points(const Mechanism& mechanism, const LinkageScene& scene) {
  Extent extent;
  const auto add = [&](const Configuration& here) {
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      if (is_drawn(mechanism, p) && here.points[p].position.allFinite())
        extent.extend(here.points[p].position);
    }
  };
  add(scene.shown);
  for (const Configuration& here : scene.motion) add(here);
  return extent;
}

/// The largest scale at which a rectangle and `room` [px] on all sides fit [px/length unit].
double fitting_scale(const Vector2d& size, const Vector2d& room) {
  const double x = size.x() > 0 ? (kWidest - room.x()) / size.x() : INFINITY;
  const double y = size.y() > 0 ? (kTallest - room.y()) / size.y() : INFINITY;
  return std::isfinite(std::min(x, y)) ? std::min(x, y) : 1;
}

/// What the parts cover in all positions, in pixels from the origin of the data.
Extent extent_of_parts(const Mechanism& mechanism, const std::vector<LinkagePart>& parts,
                       const std::vector<Configuration>& samples, double scale) {
  Extent extent;
  for (const Configuration& here : samples) {
    for (const LinkagePart& part : parts) {
      const PartPose pose = pose_of(part, mechanism, here);
      const Vector2d at(pose.at.x() * scale, -pose.at.y() * scale);
      for (const Mark& mark : part.marks) extent.extend(extent_of(placed(mark, at, pose.angle)));
    }
  }
  return extent;
}

Pen trace_pen(std::size_t k) {
  const std::vector<std::vector<double>> dashes{{}, {9, 4}, {2, 4}, {12, 3, 2, 3}};
  return {kAccents[k % std::size(kAccents)], 2, dashes[k % dashes.size()]};
}

/// The title, and under it the caption and the legend from left to right in as many lines as they need. Gives
/// where they end [px].
double add_head(Picture& picture, const Mechanism& mechanism, const LinkageScene& scene) {
  constexpr double kTitleSize = 17, kTitleBase = 30, kLine = 20, kSwatch = 26, kGap = 22;
  double bottom = 12;
  if (!picture.title.empty()) {
    Label title{{kMargin, kTitleBase}, picture.title, Anchor::start, kTitleSize, true};
    title.size =
        std::min(kTitleSize, kTitleSize * (kWidth - 2 * kMargin) / text_width(title.text, kTitleSize, true));
    picture.marks.push_back({title, {Ink::none, 0}, Ink::line});
    bottom = kTitleBase + 6;
  }
  double x = kMargin, y = bottom + kLine - 4;
  bool any = false;
  const auto room_for = [&](double width) {
    if (any && x + width > kWidth - kMargin) {
      x = kMargin;
      y += kLine;
    }
    any = true;
  };
  if (!scene.caption.empty()) {
    room_for(0);
    picture.marks.push_back(label_mark({x, y}, scene.caption, Anchor::start, kTextSize));
    picture.marks.back().id = "caption";
    x += text_width(scene.caption, kTextSize) + kGap;
  }
  for (std::size_t k = 0; k < scene.traces.size(); ++k) {
    const std::string text = "path of " + mechanism.points[scene.traces[k]].name;
    const double width = kSwatch + 6 + text_width(text, kTextSize);
    room_for(width);
    picture.marks.push_back(line_mark({x, y - 4}, {x + kSwatch, y - 4}, trace_pen(k)));
    picture.marks.push_back(label_mark({x + kSwatch + 6, y}, text, Anchor::start, kTextSize));
    x += width + kGap;
  }
  return any ? y + 4 : bottom;
}

}  // namespace

LinkageLayout lay_out(const Mechanism& mechanism, const LinkageScene& scene) {
  const std::vector<Configuration> samples = samples_of(scene);
  const Extent points = extent_of_points(mechanism, scene);
  const Vector2d size = points.isEmpty() ? Vector2d(0, 0) : Vector2d(points.sizes());
  // What surrounds the points is as large as it is at any scale: measured at one, allowed for at the next.
  double scale = fitting_scale(size, Vector2d::Constant(2 * kRoomForNames));
  Extent covered = extent_of_parts(mechanism, linkage_parts(mechanism, samples, scale), samples, scale);
  const Vector2d room = (covered.sizes() - size * scale).cwiseMax(0) + Vector2d::Constant(2 * kRoomForNames);
  scale = fitting_scale(size, room);
  covered = extent_of_parts(mechanism, linkage_parts(mechanism, samples, scale), samples, scale);

  Picture background;
  background.width = kWidth;
  background.title = mechanism.title;
  const double head = add_head(background, mechanism, scene);
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
  LinkageLayout layout{std::move(background), axes, linkage_parts(mechanism, samples, axes.scale().x()), {}};
  for (std::size_t k = 0; k < scene.traces.size(); ++k) {
    std::vector<Vector2d> path;
    for (const Configuration& here : scene.motion) path.push_back(here.points[scene.traces[k]].position);
    Mark curve = curve_mark(axes, path, trace_pen(k));
    curve.id = "path-" + mechanism.points[scene.traces[k]].name;
    layout.paths.push_back(std::move(curve));
  }
  return layout;
}

std::vector<Mark> name_marks(const Mechanism& mechanism, const LinkageLayout& layout,
                             const Configuration& here) {
  constexpr double kOfPath = 8, kOfPart = 50;  // weights: a name may rather lie on a path than on a link
  LabelPlacer placer(layout.axes.frame());
  for (const Mark& path : layout.paths) placer.avoid(path, kOfPath);
  for (const LinkagePart& part : layout.parts) {
    const PartPose pose = pose_of(part, mechanism, here);
    for (const Mark& mark : part.marks) placer.avoid(placed(mark, layout.place(pose), pose.angle), kOfPart);
  }
  std::vector<Mark> names;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (!is_drawn(mechanism, p)) continue;
    const std::string& name = mechanism.points[p].name;
    names.push_back(placer.place(layout.axes.at(here.points[p].position), name, kNameSize));
    names.back().id = "name-" + name;
  }
  return names;
}

}  // namespace oblique
