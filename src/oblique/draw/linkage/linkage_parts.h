// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <oblique/draw/picture/picture.h>
#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/mechanism.h>

namespace oblique::draw {

/// A stiff piece of a drawn mechanism. Its marks are drawn about the origin of what carries it: x in pixels
/// along a link's first → second point or a prismatic joint's line, y to the right of that.
struct LinkagePart {
  enum class Carrier {
    frame,  ///< its origin is the place of the point `index`, and it never turns
    guide,  ///< its origin is the first point of the line of the prismatic joint `index`
    body,   ///< its origin is the first point of the link `index`
    slide,  ///< its origin is the point of the prismatic joint `index`; it turns with the line
    drive,  ///< as a prismatic joint, but x goes the way in which the prismatic joint's drive moves it
    point,  ///< its origin is the point `index`, and it never turns
  };
  Carrier carrier = Carrier::frame;
  std::size_t index = 0;
  std::vector<Mark> marks{};
};

/// Where a part stands at a moment [length unit], and how far it is turned to the left [rad]: without jumps
/// along a motion, but where a drive turns back.
struct PartPose {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double angle = 0;
};
PartPose pose_of(const LinkagePart& part, const mechanism::Mechanism& mechanism,
                 const mechanism::Configuration& here);

/// A mark moved by `at` [px] after it is turned to the left by `angle` [rad]. Boxes and labels are moved
/// only.
Mark placed(const Mark& mark, const Eigen::Vector2d& at, double angle);

/// Everything that is drawn of a mechanism but its names, lower things first: the insides of plates, supports
/// and guides, whose hatching so lies before plates, the edges of plates and the bars, blocks with the arrows
/// of those that are driven, pins. `motion` says how long guides have to be; `scale` [px/length unit]. Pins
/// have the ids "pin-B", links "body-AB" and "inside-AB", blocks "slide-s", their arrows "arrow-s", hatching
/// "ground-A" under a point and "guide-s" along a guide.
std::vector<LinkagePart> linkage_parts(const mechanism::Mechanism& mechanism,
                                       const std::vector<mechanism::Configuration>& motion, double scale);

/// How high parts lie. Paths go under blocks, and leader lines of names under pins.
enum class Layer {
  bodies,  ///< and the frame
  blocks,  ///< of prismatic joints, with their arrows
  pins,
};
/// Those of `linkage_parts` in one layer.
std::span<const LinkagePart> parts_in(Layer layer, const std::vector<LinkagePart>& parts);

/// Whether a point is drawn: points that only name a line of the frame are not.
bool is_drawn(const mechanism::Mechanism& mechanism, std::size_t point);

}  // namespace oblique::draw
