// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::mechanism {

/// A point as the conditions of a group see it.
struct PointRef {
  enum class Kind : std::uint8_t {
    known,    ///< of the frame or placed by a group before: its motion is given
    free,     ///< an unknown of the group: x and y
    carried,  ///< by a platform link of the group
  };
  Kind kind = Kind::known;
  std::size_t point = 0;                            ///< index in Mechanism::points
  std::size_t member = 0;                           ///< free: index in free_points; carried: in platforms
  Eigen::Vector2d local = Eigen::Vector2d::Zero();  ///< carried: in the platform link's frame [length unit]
};

/// A line, its offset included.
struct LineRef {
  enum class Kind : std::uint8_t { fixed, known, carried };
  Kind kind = Kind::fixed;
  std::size_t body = 0;    ///< known: index in Mechanism::bodies
  std::size_t member = 0;  ///< carried: index in platforms
  /// A point of the line, beside its first named point, and the unit vector to the second: in the frame of
  /// the link, or (fixed) of the world.
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
};

/// One condition g = 0 on the unknowns of a group; d = a − b, or a − the line's point; u along, n to the
/// left.
struct Condition {
  enum class Kind : std::uint8_t {
    distance,     ///< (d·d − value²)/2·value: a and b are joined by a binary link
    coincidence,  ///< d: two conditions, a is pinned to b
    on_line,      ///< n·d: a lies on the line
    along,        ///< u·d − s: the drive gives where a lies on the line
    orientation,  ///< the angle of platform link `body` against the carrier of the line is `value` more than
                  ///< 0, or the drive's (against the frame)
  };
  Kind kind = Kind::distance;
  PointRef a, b;
  LineRef line;                           ///< on_line, along; of an orientation the carrier alone
  double value = 0;                       ///< [length unit], [rad]
  std::size_t member = 0;                 ///< orientation: the platform link
  std::size_t link = 0;                   ///< distance: the link that keeps it, index in binary_links
  std::optional<std::size_t> drive = {};  ///< index in Mechanism::drives
};

/// A binary link of a group: a link of which only two points matter, and which its distance stands for.
struct BinaryLink {
  std::size_t body = 0;          ///< index in Mechanism::bodies
  std::size_t from = 0, to = 0;  ///< indices in Mechanism::points
  double cosine = 1, sine = 0;   ///< of the angle from the link's x axis to from → to
};

/// A slider block of a group: a link that slides without turning on another and is pinned in one point.
struct SliderBlock {
  std::size_t body = 0;           ///< index in Mechanism::bodies
  std::size_t revolute = 0;       ///< index in Mechanism::points
  std::optional<std::size_t> on;  ///< the link it slides on; none: the frame
  double cosine = 1, sine = 0;    ///< of its angle against that link
};

/// A group as equations for as few unknowns as it has: binary links and slider blocks are replaced by
/// conditions between what they join. Unknowns, in this order: x, y of the first point and the angle of each
/// platform link; x, y of each free point.
struct GroupEquations {
  std::vector<std::size_t> platforms;    ///< platform links: links whose poses are unknown
  std::vector<std::size_t> free_points;  ///< points of binary links and slider blocks alone
  std::vector<Condition> conditions;
  std::vector<BinaryLink> binary_links;
  std::vector<SliderBlock> blocks;

  std::size_t unknowns() const { return 3 * platforms.size() + 2 * free_points.size(); }
};

/// Where the unknowns of a group stand: position, cosine and sine of each platform link; the free points.
struct GroupPose {
  struct Platform {
    Eigen::Vector2d position;
    double cosine, sine;
  };
  std::vector<Platform> platforms;
  std::vector<Eigen::Vector2d> points;
  int side = 0;  ///< as in Group
};

/// The members of a group before it is reduced.
struct GroupMembers {
  std::vector<std::size_t> bodies;  ///< in file order
  std::vector<std::size_t> points;  ///< that are unknowns of the group, not merely carried by its links
  std::vector<std::size_t> slides;  ///< whose pairs belong to it
  std::vector<std::size_t> drives;
};

/// Writes a group as equations; `known` says of each point of the mechanism whether the groups before give
/// it.
GroupEquations reduce(const Mechanism& mechanism, const GroupMembers& members,
                      const std::vector<bool>& known);

/// The line of a slide in its carrier's frame (member and kind as for a known carrier).
LineRef line_of(const Mechanism& mechanism, const Slide& slide);

}  // namespace oblique::mechanism
