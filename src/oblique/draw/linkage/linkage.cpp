// SPDX-License-Identifier: MIT
#include <oblique/draw/linkage/linkage.h>

#include <algorithm>

#include <oblique/draw/linkage/linkage_layout.h>
#include <oblique/draw/picture/rounded_hull.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

/// Whether a link can only turn about a point of the frame, or only go along a guide there.
bool is_led_by_frame(const mechanism::Mechanism& mechanism, std::size_t body) {
  const std::vector<mechanism::BodyPoint>& points = mechanism.bodies[body].points;
  const bool pinned = std::any_of(points.begin(), points.end(), [&](const mechanism::BodyPoint& point) {
    return mechanism.points[point.point].fixed;
  });
  const bool guided =
      std::any_of(mechanism.slides.begin(), mechanism.slides.end(),
                  [&](const mechanism::Slide& slide) { return slide.of == body && !slide.carrier; });
  return pinned || guided;
}

/// A position drawn as thin lines and pale plates.
void add_faint(std::vector<Mark>& marks, const mechanism::Mechanism& mechanism, const Axes& axes,
               const mechanism::Configuration& here, double strength) {
  constexpr double kHalfWidth = 0.8, kOfBars = 0.7, kOfPlates = 0.06, kOfEdges = 0.4;
  for (const mechanism::Body& body : mechanism.bodies) {
    std::vector<Vector2d> points;
    for (const mechanism::BodyPoint& point : body.points)
      points.push_back(axes.at(here.points[point.point].position));
    Mark mark{rounded_hull(std::move(points), kHalfWidth), {Ink::none, 0}, Ink::blue};
    mark.opacity = strength * (body.points.size() == 2 ? kOfBars : kOfPlates);
    marks.push_back(mark);
    if (body.points.size() == 2) continue;
    mark.fill = Ink::none;
    mark.pen = {Ink::blue, 1};
    mark.opacity = strength * kOfEdges;
    marks.push_back(std::move(mark));
  }
}

}  // namespace

std::vector<std::size_t> points_to_trace(const mechanism::Mechanism& mechanism) {
  std::vector<std::size_t> marks, joints;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    const std::vector<std::size_t> bodies = mechanism.bodies_at(p);
    const bool guided =
        std::any_of(mechanism.slides.begin(), mechanism.slides.end(),
                    [&](const mechanism::Slide& slide) { return slide.point == p && !slide.carrier; });
    const bool led = std::any_of(bodies.begin(), bodies.end(),
                                 [&](std::size_t body) { return is_led_by_frame(mechanism, body); });
    if (bodies.empty() || mechanism.points[p].fixed || guided || led) continue;
    (bodies.size() == 1 ? marks : joints).push_back(p);
  }
  std::vector<std::size_t> chosen = marks.empty() ? joints : marks;
  chosen.resize(std::min(chosen.size(), std::size(kAccents)));
  return chosen;
}

Picture draw_linkage(const mechanism::Mechanism& mechanism, const LinkageScene& scene) {
  const LinkageLayout layout = lay_out(mechanism, scene);
  Picture picture = layout.background;
  for (std::size_t k = 0; k < scene.others.size(); ++k) {
    if (scene.others[k].status == mechanism::Status::open) continue;
    constexpr double kFaintest = 0.2, kStrongest = 0.9;
    const double along = static_cast<double>(k + 1) / static_cast<double>(scene.others.size());
    add_faint(picture.marks, mechanism, layout.axes, scene.others[k],
              kFaintest + (kStrongest - kFaintest) * along);
  }
  const std::vector<Vector2d> analog = scene.analog ? scene.analog->shown : std::vector<Vector2d>();
  const NameMarks names = name_marks(mechanism, layout, scene.shown, analog);
  const auto add = [&](const std::vector<Mark>& marks) {
    picture.marks.insert(picture.marks.end(), marks.begin(), marks.end());
  };
  const auto add_parts = [&](Layer layer) {
    for (const LinkagePart& part : parts_in(layer, layout.parts)) {
      const PartPose pose = pose_of(part, mechanism, scene.shown);
      for (const Mark& mark : part.marks)
        picture.marks.push_back(placed(mark, layout.place(pose), pose.angle));
    }
  };
  add_parts(Layer::bodies);
  add(layout.paths);
  add_parts(Layer::blocks);
  add(names.leaders);
  add_parts(Layer::pins);
  for (const AnalogShape& shape : layout.analog)
    picture.marks.push_back(analog_mark(shape, layout.axes, analog));
  add(names.names);
  return picture;
}

}  // namespace oblique::draw
