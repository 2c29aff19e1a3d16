// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// The stretch of a motion that an analysis looks at. Its instants are named by a place u from 0 to 1, in
/// which the motion is smooth up to its limits: there the velocities grow as 1/√(limit − t), and dt/du falls
/// as fast.
struct MotionRange {
  enum class Kind {
    turn,      ///< one turn of the first drive
    until,     ///< the time that the file gives
    limits,    ///< from one limit to the other
    to_limit,  ///< there is a limit on one side only, or before the time that the file gives
  };
  Kind kind = Kind::turn;
  double begin = 0, end = 0;              ///< [s]
  bool from_limit = false;                ///< it begins at a limit
  bool at_limit = false;                  ///< it ends at one
  bool closed = false;                    ///< at its end all points are where they were at its beginning
  MotionLimits range;                     ///< the limits that were found
  std::vector<MotionEvent> changes = {};  ///< the change points on the way
  std::size_t samples = 0;                ///< intervals of u in which extremes are looked for

  double duration() const { return end - begin; }
  double time(double u) const;  ///< [s]
  double rate(double u) const;  ///< dt/du [s]
};

/// A turn of the first drive; where limits forbid that, the way between them; where the file says how long it
/// moves, that. Throws as `find_range` and `cycle`.
MotionRange plan_motion_range(const Mechanism& mechanism, const Structure& structure);

/// A follower that goes by places of a motion range. The mechanism and the structure have to outlive it.
class RangeWalk {
 public:
  RangeWalk(const Mechanism& mechanism, const Structure& structure, MotionRange motion_range);

  /// Goes to place `u` in [0, 1]. A dead centre, where rates have no value, is passed by as closely as they
  /// still have one.
  const Configuration& go(double u);

  const Mechanism& mechanism() const { return mechanism_; }
  const Structure& structure() const { return structure_; }
  const MotionRange& motion_range() const { return motion_range_; }
  const Configuration& here() const { return *here_; }
  double place() const { return place_; }
  double time() const { return time_; }
  const std::vector<DriveState>& drives() const { return drives_; }
  double normalised_determinant(std::size_t group) const { return follower_.normalised_determinant(group); }

 private:
  const Mechanism& mechanism_;
  const Structure& structure_;
  MotionRange motion_range_;
  Follower follower_;
  DriveClock clock_;
  const Configuration* here_ = nullptr;
  std::vector<DriveState> drives_;
  double place_ = 0, time_ = 0;
};

}  // namespace oblique::mechanism
