// SPDX-License-Identifier: MIT
#include <oblique/draw/linkage/slider_blocks.h>

#include <algorithm>
#include <cmath>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Carrier = LinkagePart::Carrier;

/// The drive that moves a prismatic joint, or nothing.
const mechanism::Drive* drive_of_slide(const mechanism::Mechanism& mechanism, std::size_t slide) {
  const auto found = std::find_if(mechanism.drives.begin(), mechanism.drives.end(),
                                  [&](const mechanism::Drive& drive) { return drive.slide == slide; });
  return found == mechanism.drives.end() ? nullptr : &*found;
}

/// A polygon in the colour of drives, as driven links have it; what lies under it does not show through.
void add_driven(std::vector<Mark>& marks, const std::vector<Vector2d>& corners, const Mark& edge) {
  Mark inside = polyline_mark(corners, {Ink::none, 0}, true);
  inside.fill = Ink::paper;
  marks.push_back(inside);
  inside.fill = Ink::orange;
  inside.opacity = kInsideOpacity;
  marks.push_back(std::move(inside));
  marks.push_back(edge);
}

LinkagePart block_part(const mechanism::Mechanism& mechanism, std::size_t index) {
  const Vector2d half(kSliderLength / 2, kSliderHeight / 2);
  const std::vector<Vector2d> corners{-half, {half.x(), -half.y()}, half, {-half.x(), half.y()}};
  constexpr double kEdge = 1.5;  // [px]
  LinkagePart part{Carrier::slide, index};
  Mark block = polyline_mark(corners, {Ink::line, kEdge}, true);
  block.id = "slide-" + mechanism.slides[index].name;
  if (drive_of_slide(mechanism, index) != nullptr) {
    add_driven(part.marks, corners, block);
  } else {
    block.fill = Ink::paper;
    part.marks.push_back(std::move(block));
  }
  return part;
}

/// Before a driven block, on its line.
LinkagePart arrow_part(const mechanism::Mechanism& mechanism, std::size_t index) {
  constexpr double kTail = kSliderLength / 2 + 4, kNeck = kTail + 12, kTip = kNeck + 11;  // [px]
  constexpr double kHalfShaft = 2.5, kHalfHead = 7;                                       // [px]
  const std::vector<Vector2d> corners{
      {kTail, -kHalfShaft}, {kNeck, -kHalfShaft}, {kNeck, -kHalfHead}, {kTip, 0},
      {kNeck, kHalfHead},   {kNeck, kHalfShaft},  {kTail, kHalfShaft}};
  LinkagePart part{Carrier::drive, index};
  Mark edge = polyline_mark(corners, {Ink::line, kThinLine}, true);
  edge.id = "arrow-" + mechanism.slides[index].name;
  add_driven(part.marks, corners, edge);
  return part;
}

}  // namespace

std::vector<LinkagePart> slider_blocks(const mechanism::Mechanism& mechanism) {
  std::vector<LinkagePart> parts;
  for (const bool driven : {false, true}) {
    for (std::size_t s = 0; s < mechanism.slides.size(); ++s) {
      if ((drive_of_slide(mechanism, s) != nullptr) != driven) continue;
      parts.push_back(block_part(mechanism, s));
      if (driven) parts.push_back(arrow_part(mechanism, s));
    }
  }
  return parts;
}

bool goes_back(const mechanism::Mechanism& mechanism, std::size_t slide,
               const mechanism::Configuration& here) {
  const double velocity = here.slides[slide].velocity;
  if (std::isfinite(velocity) && velocity != 0) return velocity < 0;
  const mechanism::Drive* const drive = drive_of_slide(mechanism, slide);
  return drive != nullptr && drive->speed < 0;
}

}  // namespace oblique::draw
