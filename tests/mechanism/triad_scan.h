// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include <oblique/mechanism/triad/triad.h>

namespace oblique::mechanism {

/// How far a leg's condition is from holding [length unit], from the geometry alone.
double closing_error(const Leg& leg, const PlatformPose& pose);

/// The largest of the three, without its sign.
double closing_error(const std::array<Leg, 3>& legs, const PlatformPose& pose);

/// The poses of a platform, found without any characteristic equation: two legs are held, which leaves a
/// one-dimensional motion in closed form; it is walked through in `steps` places, and the third leg's error
/// says where it closes.
std::vector<PlatformPose> scan_poses(const std::array<Leg, 3>& legs, int steps);

}  // namespace oblique::mechanism
