// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include <oblique/draw/linkage/linkage_layout.h>

namespace oblique::draw {

/// A mechanism that is shown again and again while somebody holds it: what stands still is laid out and drawn
/// once, and what moves is drawn for a position.
class LiveLinkage {
 public:
  /// As `draw_linkage` lays it out; `scene.motion` says how much room it takes. The mechanism must outlive
  /// it.
  LiveLinkage(const mechanism::Mechanism& mechanism, const LinkageScene& scene);

  /// Title, legend, axes and paths.
  Picture background() const;

  /// The mechanism in a position that has all its numbers, pale: what is exact is the ground on which the
  /// errors are seen. Names go with their points, on the side that is clear in most positions.
  std::vector<Mark> exact(const mechanism::Configuration& here) const;

  /// The analog mechanism with its points at `places` [length unit], as many as the mechanism has. Shapes of
  /// which a place has no numbers are left out.
  std::vector<Mark> analog(const std::vector<Eigen::Vector2d>& places) const;

  /// Where a place of the mechanism [length unit] lies in the picture [px], and the other way round.
  Eigen::Vector2d pixel(const Eigen::Vector2d& place) const { return layout_.axes.at(place); }
  Eigen::Vector2d place(const Eigen::Vector2d& pixel) const;

 private:
  struct Name {
    std::size_t point = 0;
    Mark mark;  ///< about the point
  };

  const mechanism::Mechanism& mechanism_;
  LinkageLayout layout_;
  std::vector<Name> names_;
};

}  // namespace oblique::draw
