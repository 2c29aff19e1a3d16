// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include <oblique/draw/linkage/linkage_layout.h>

namespace oblique::draw {

/// The name of a point, drawn about the point, and how far it is from there in each frame [px].
struct MovingName {
  std::size_t point = 0;
  Mark mark;
  std::vector<Eigen::Vector2d> offsets;  ///< the last one as the first
};

/// The names of all drawn points for an animation whose last frame is as its first. Each goes with its point
/// on a side that is clear, and round the point to another side where that is better: over all frames the
/// weights of what it covers and the way that it goes are together the least that there is (dynamic
/// programming over the places around the point, R. Bellman 1957). `analog`: the points of the analog
/// mechanism in each frame, or nothing.
std::vector<MovingName> moving_names(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                                     const std::vector<mechanism::Configuration>& frames,
                                     const std::vector<std::vector<Eigen::Vector2d>>& analog);

}  // namespace oblique::draw
