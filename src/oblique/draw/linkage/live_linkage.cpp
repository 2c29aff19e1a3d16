// SPDX-License-Identifier: MIT
#include <oblique/draw/linkage/live_linkage.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr double kPale = 0.55;  ///< opacity of what is exact

/// Some positions of a motion, evenly chosen, of those that have their numbers.
std::vector<const mechanism::Configuration*> some_of(const LinkageScene& scene) {
  constexpr std::size_t kMost = 12;
  std::vector<const mechanism::Configuration*> some;
  const std::size_t stride = scene.motion.size() / kMost + 1;
  for (std::size_t k = 0; k < scene.motion.size(); k += stride) {
    if (scene.motion[k].status != mechanism::Status::open) some.push_back(&scene.motion[k]);
  }
  if (some.empty() && scene.shown.status != mechanism::Status::open) some.push_back(&scene.shown);
  return some;
}

/// Eight places for the middle of a name about its point [px].
std::array<Vector2d, 8> places_beside(const Vector2d& half) {
  constexpr double kGap = 9;  // [px]
  std::array<Vector2d, 8> places;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double angle = (static_cast<double>(k) + 1) * std::numbers::pi / 4;
    const Vector2d way(std::cos(angle), -std::sin(angle));
    places[k] = kGap * way + (std::numbers::sqrt2 * way).cwiseMax(-1).cwiseMin(1).cwiseProduct(half);
  }
  return places;
}

}  // namespace

LiveLinkage::LiveLinkage(const mechanism::Mechanism& mechanism, const LinkageScene& scene)
    : mechanism_(mechanism), layout_(lay_out(mechanism, scene)) {
  const std::vector<const mechanism::Configuration*> positions = some_of(scene);
  std::vector<LabelPlacer> placers;
  placers.reserve(positions.size());
  for (const mechanism::Configuration* here : positions)
    placers.push_back(placer_among(mechanism, layout_, *here, {}));
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (!is_drawn(mechanism, p)) continue;
    Mark mark = label_mark({0, 0}, mechanism.points[p].name, Anchor::middle, kNameSize);
    std::get<Label>(mark.shape).bold = true;
    const Eigen::AlignedBox<double, 2> own = extent_of(mark);
    const Vector2d half = own.sizes() / 2;
    const auto places = places_beside(half);
    std::array<double, 8> costs{};
    for (std::size_t k = 0; k < positions.size(); ++k) {
      const Vector2d pin = pixel(positions[k]->points[p].position);
      for (std::size_t side = 0; side < places.size(); ++side) {
        const Vector2d middle = pin + places[side];
        costs[side] += placers[k].cost({middle - half, middle + half}, pin);
      }
    }
    const auto best = static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
    mark = placed(mark, places[best] - own.center(), 0);
    mark.id = "name-" + mechanism.points[p].name;
    for (std::size_t k = 0; k < positions.size(); ++k) {
      const Vector2d pin = pixel(positions[k]->points[p].position);
      placers[k].add_name(placed(mark, pin, 0), pin);
    }
    names_.push_back({p, std::move(mark)});
  }
}

Picture LiveLinkage::background() const {
  Picture picture = layout_.background;
  picture.marks.insert(picture.marks.end(), layout_.paths.begin(), layout_.paths.end());
  return picture;
}

std::vector<Mark> LiveLinkage::exact(const mechanism::Configuration& here) const {
  std::vector<Mark> marks;
  for (const Layer layer : {Layer::bodies, Layer::blocks, Layer::pins}) {
    for (const LinkagePart& part : parts_in(layer, layout_.parts)) {
      const PartPose pose = pose_of(part, mechanism_, here);
      for (const Mark& mark : part.marks) {
        marks.push_back(placed(mark, layout_.place(pose), pose.angle));
        marks.back().opacity *= kPale;
      }
    }
  }
  for (const Name& name : names_)
    marks.push_back(placed(name.mark, pixel(here.points[name.point].position), 0));
  return marks;
}

std::vector<Mark> LiveLinkage::analog(const std::vector<Vector2d>& places) const {
  std::vector<Mark> marks;
  for (const AnalogShape& shape : layout_.analog) {
    const bool known = std::all_of(shape.points.begin(), shape.points.end(),
                                   [&](std::size_t p) { return places[p].allFinite(); });
    if (known) marks.push_back(analog_mark(shape, layout_.axes, places));
  }
  return marks;
}

Vector2d LiveLinkage::place(const Vector2d& pixel) const {
  const Vector2d way = pixel - layout_.axes.at(Vector2d::Zero()), scale = layout_.axes.scale();
  return {way.x() / scale.x(), -way.y() / scale.y()};
}

}  // namespace oblique::draw
