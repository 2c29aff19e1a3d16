// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include <oblique/draw/animation/animation.h>
#include <oblique/draw/linkage/linkage_layout.h>

namespace oblique::draw {

/// Where a group of marks stands in a frame: [px], and [°] clockwise.
struct Placing {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double turned = 0;
};

/// Marks that move together, drawn about their own origin; or one line whose corners move.
struct MovingGroup {
  std::vector<Mark> marks;
  std::vector<Placing> placings;  ///< one for each frame; one alone: it stands still
  bool turns = false;
  std::vector<std::vector<Eigen::Vector2d>> corners{};  ///< [px] of a line, for each frame; none: it is stiff
  bool closed = false;                                  ///< the line ends where it begins

  bool moves() const { return placings.size() > 1 || corners.size() > 1; }
};

/// All that is drawn over the background, lower things first.
std::vector<MovingGroup> moving_groups(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                                       const LinkageAnimation& animation);

/// The marks of a group in a frame.
std::vector<Mark> marks_in_frame(const MovingGroup& group, std::size_t frame);

}  // namespace oblique::draw
