// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/motion_event.h>
#include <oblique/mechanism/solver/kinematics.h>

namespace oblique::mechanism {

/// A mechanism on its way along one branch of its positions: the workspace of a Follower, of which
/// `crossings` makes the steps.
///
/// A step is tried in `next` and accepted to `here`. It is good where no link turns by more than 30° in it,
/// no group's normalised determinant changes sign or by more than a factor of two, and Newton's method finds
/// its guess nearly right and contracts: then no group has changed its mode.
struct BranchWalk {
  struct Course {  ///< of one group
    int side = 0;
    double determinant = 1;  ///< normalised determinant (GroupSolver::normalised_determinant)
    double derivative = 0;   ///< of it [1/s]
    double peak = 1;         ///< its largest magnitude so far
  };
  /// A place on the branch from which it can be followed anew.
  struct Place {
    Configuration here;
    std::vector<Course> courses;
    std::vector<DriveState> drives;
    std::vector<double> angles;
  };
  enum class Verdict : std::uint8_t { good, too_far, blocked };

  /// Before its start, at time 0. Mechanism and structure have to outlive it.
  BranchWalk(const Mechanism& whole, const Structure& structure);

  /// Started where `from` stands on another walk's branch, at time 0, each drive going straight on at these
  /// rates.
  BranchWalk(const BranchWalk& other, const Place& from, std::vector<double> rates);

  void start();
  void drives_at(double t, std::vector<DriveState>& states);

  /// Taylor's formula as a guess of the positions a time `dt` on, in `next`.
  void predict(double dt);
  /// Puts the mechanism together at time `t`, in `next`, and judges the step.
  Verdict attempt(double t);
  /// Puts all groups together at time `t`, in `next`, however far the step; false where one is open.
  bool place_all(double t);
  /// Stands in `next`, at time `t`.
  void accept(double t);
  /// The derivatives of the courses, from a small step that is not made.
  void probe(double dt);

  Place place() const { return {here, courses, drives, angles}; }

  /// Finishes `shown` for a time at which the walk itself does not stand.
  void show(double t);
  /// No numbers at time `t`, in `shown`.
  void show_open(double t, std::size_t group);

  Kinematics kinematics;
  const Mechanism& mechanism;
  DriveClock clock;
  std::vector<double> straight;  ///< instead of the clock: how fast each drive goes, on from `straight_from`
  std::vector<DriveState> straight_from;
  std::vector<Course> courses;
  std::vector<double> determinants;  ///< of the configuration attempted
  std::vector<DriveState> drives, next_drives;
  Configuration here, next, shown;
  std::vector<double> angles;  ///< continuous, of the last configuration that was not open
  Place last_clear;            ///< the last place before the steps became small
  std::vector<MotionEvent> events;
  bool started = false;
  bool is_open = false;
  bool tracks = false;             ///< some group starts from a guess
  bool stops_at_infinity = false;  ///< and does not pass it
  std::size_t culprit = 0;         ///< the group that stopped the last attempt
  double time = 0;
  double step = 0;      ///< longest that may be tried [s]
  double smallest = 0;  ///< step that counts as none [s]
  double duration_of_degree = 0;

 private:
  void set_pace(std::span<const double> rates);
  Verdict judge(std::size_t g, double dt) const;
  void copy_angles();
};

}  // namespace oblique::mechanism
