// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/motion_event.h>
#include <oblique/mechanism/solver/kinematics.h>

namespace oblique::mechanism {

/// A motion that ends at infinity stops this far before it, where the mechanism is a thousand times its size
/// away [rad of the fastest drive].
inline constexpr double kBeforeInfinity = 1e-3;

/// Follows a mechanism from time 0, on one branch of its positions. Steps are made so small that no body
/// turns by more than 30° in one, that no group's regularity (GroupSolver) changes sign or by more than a
/// factor of two, and that Newton's method finds its guess nearly right and contracts; so a group never
/// changes its mode between two steps. Where the regularity goes to zero, the steps go to zero with it, and
/// the second order of the conditions (Singularity) says what is ahead: the branch turns back, which is a
/// limit, or another mode crosses it, which is a change point and passed by the velocity. Nothing of this
/// depends on the times asked for.
///
/// Beyond a limit the configuration is open until the drives come to where the branch that was left goes on:
/// there the bodies could have come without being taken apart. Of a single drive these are the two ends of
/// the branch, wherever in its turns; of several drives, what the straight way of all of them reaches.
class Follower {
 public:
  Follower(const Mechanism& mechanism, const Structure& structure);

  /// The configuration at time `t` [s], before or after the one of the call before.
  const Configuration& advance(double t);

  /// As `advance`, but stops at the first limit on the way, or at infinity, and says where. The configuration
  /// is then the last one before it, within 1e-10 rad of the fastest drive of a limit.
  std::optional<MotionEvent> advance_to_limit(double t);

  const Configuration& here() const { return here_; }
  double time() const { return time_; }
  const std::vector<DriveState>& drives() const { return drives_; }
  const std::vector<MotionEvent>& events() const { return events_; }
  /// Of a group where the follower stands (GroupSolver::regularity).
  double regularity(std::size_t group) const { return courses_[group].regularity; }

 private:
  struct Course {  ///< of one group
    int side = 0;
    double regularity = 1;
    double slope = 0;  ///< of the regularity [1/s]
    double peak = 1;   ///< largest regularity so far
  };
  /// A place on the branch from which it can be followed anew.
  struct Standing {
    Configuration here;
    std::vector<Course> courses;
    std::vector<DriveState> drives;
    std::vector<double> angles;
  };
  /// Where the drives are while the configuration is open.
  struct Gap {
    Standing behind;     ///< on the branch, before the end at which it was left
    Standing ahead;      ///< of a single drive that turns: beside the branch's other end
    double end = 0;      ///< of a single drive: its value where the branch was left
    double outward = 0;  ///< ±1: in which direction it lies beyond
    double width = 0;    ///< how far beyond it comes to the other end; infinite where to none
  };
  enum class Verdict { good, too_far, blocked };
  enum class Crossing {
    passed,
    limit,
    amidst,   ///< the time asked for lies where the modes meet: it is in shown_
    regular,  ///< there is nothing to cross: smaller steps will do
  };

  Follower(const Follower& other, const Standing& from, std::vector<double> way);

  void set_pace(std::span<const double> rates);
  void start();
  void probe(double dt);
  void predict(double dt);
  void drives_at(double t, std::vector<DriveState>& states);
  Verdict attempt(double t);
  Verdict judge(std::size_t g, double dt) const;
  void accept(double t);
  Standing standing() const { return {here_, courses_, drives_, angles_}; }
  void show(double t);
  void show_open(double t, std::size_t group);
  void copy_angles();

  // follower_limits.cpp
  Crossing step_towards(double t);
  Crossing cross(std::size_t g, double t, bool is_last);
  Crossing cross_infinity(std::size_t g, double t);
  Crossing cross_modes(std::size_t g, double t, double zero);
  Crossing end_at(std::size_t g, double t, double tau, const Singularity& singularity);
  bool place_all(double t);
  bool place_next_to_velocity(std::size_t g, double dt);

  // follower_return.cpp
  void leave_branch();
  bool come_back(double t);
  bool come_back_alone(double t);
  bool come_back_together(double t);
  bool enter(const Standing& from, double t);

  Kinematics kinematics_;
  const Mechanism& mechanism_;
  DriveClock clock_;
  std::vector<double> way_;  ///< instead of the clock: how fast each drive goes, straight on from `way_from_`
  std::vector<DriveState> way_from_;
  std::vector<Course> courses_;
  std::vector<double> regularities_;  ///< of the configuration attempted
  std::vector<DriveState> drives_, next_drives_;
  Configuration here_, next_, shown_;
  std::vector<double> angles_;  ///< continuous, of the last configuration that was not open
  Standing standing_;           ///< the last place before the steps became small
  std::optional<Gap> gap_;      ///< while open
  std::vector<MotionEvent> events_;
  bool started_ = false;
  bool tracks_ = false;  ///< some group starts from a guess
  bool open_ = false;
  bool stop_at_limit_ = false;
  std::size_t culprit_ = 0;  ///< the group that stopped the last attempt
  double time_ = 0;
  double step_ = 0;      ///< longest that may be tried [s]
  double smallest_ = 0;  ///< step that counts as none [s]
  double duration_of_degree_ = 0;
};

}  // namespace oblique::mechanism
