// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <oblique/draw/picture.h>
#include <oblique/mechanism/configuration.h>
#include <oblique/mechanism/mechanism.h>

namespace oblique {

/// A stiff piece of a drawn mechanism. Its marks are drawn about the origin of what carries it: x in pixels
/// along a body's first → second point or a slide's line, y to the right of that.
struct LinkagePart {
  enum class Carrier {
    frame,  ///< its origin is the place of the point `index`, and it never turns
    guide,  ///< its origin is the first point of the line of the slide `index`
    body,   ///< its origin is the first point of the body `index`
    slide,  ///< its origin is the point of the slide `index`; it turns with the line
    point,  ///< its origin is the point `index`, and it never turns
  };
  Carrier carrier = Carrier::frame;
  std::size_t index = 0;
  std::vector<Mark> marks{};
};

/// Where a part stands at a moment [length unit], and how far it is turned to the left [rad]: without jumps
/// along a motion.
struct PartPose {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double angle = 0;
};
PartPose pose_of(const LinkagePart& part, const Mechanism& mechanism, const Configuration& here);

/// A mark moved by `at` [px] after it is turned to the left by `angle` [rad]. Boxes and labels are moved
/// only.
Mark placed(const Mark& mark, const Eigen::Vector2d& at, double angle);

/// Everything that is drawn of a mechanism but its names, lower things first: supports and guides, bodies,
/// blocks, pins. `motion` says how long guides have to be; `scale` [px/length unit]. Pins have the ids
/// "pin-B", bodies "body-AB", blocks "slide-s".
std::vector<LinkagePart> linkage_parts(const Mechanism& mechanism, const std::vector<Configuration>& motion,
                                       double scale);

/// Whether a point is drawn: points that only name a line of the frame are not.
bool is_drawn(const Mechanism& mechanism, std::size_t point);

}  // namespace oblique
