// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::mechanism {

/// How the mechanism stands.
enum class Status {
  ok,
  dead_centre,  ///< a group's assembly modes meet: positions are good, rates of the group have no value
  open,         ///< a group cannot be assembled: no numbers
};

/// "ok", "dead-centre", "open".
std::string_view status_name(Status status);

/// Position, velocity and acceleration of a point [length unit, s].
struct PointState {
  Eigen::Vector2d position;
  Eigen::Vector2d velocity;
  Eigen::Vector2d acceleration;
};

/// Angle of a body's first → second point from +x [rad], and its rates [rad/s], [rad/s²].
struct BodyState {
  double angle;
  double omega;
  double alpha;
  double cosine;  ///< of the angle
  double sine;
};

/// Where a prismatic joint's point lies on its line, from beside the line's first named point towards the
/// second, and its rates [length unit, s].
struct SlideState {
  double position;
  double velocity;
  double acceleration;
};

/// All points, bodies and prismatic joints of a mechanism at one moment, indexed as in Mechanism. What has no
/// value is NaN.
struct Configuration {
  std::vector<PointState> points;
  std::vector<BodyState> bodies;
  std::vector<SlideState> slides;
  Status status = Status::ok;
  std::optional<std::size_t> group;  ///< the first group that is not `ok`, index in Structure::groups
};

/// The configuration in which only the frame has a place.
Configuration frame_configuration(const Mechanism& mechanism);

/// Gives the velocities of the same motion passed the other way.
void turn_back(Configuration& configuration);

/// Takes away all numbers but those of the frame.
void clear(const Mechanism& mechanism, Configuration& configuration);

}  // namespace oblique::mechanism
