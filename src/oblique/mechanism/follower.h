// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/mechanism/configuration.h>
#include <oblique/mechanism/drive_law.h>
#include <oblique/mechanism/kinematics.h>

namespace oblique {

/// Something that happens to a group on the way.
struct MotionEvent {
  enum class Kind {
    limit,    ///< a dead centre beyond which the group cannot be assembled
    return_,  ///< from beyond it
    change,   ///< its modes meet and part again: it passes by its velocity
  };
  Kind kind = Kind::limit;
  double time = 0;        ///< [s]
  std::size_t group = 0;  ///< index in Structure::groups
};

/// Follows a mechanism from time 0. Steps are made so small that no body turns by more than 30° in one, that
/// no group's regularity (GroupSolver) changes sign or by more than a factor of two, and that Newton's method
/// finds its guess nearly right; so a group never changes its mode between two steps. Where the regularity
/// goes to zero, the steps go to zero with it; then a mode on the other side is looked for: none is a limit,
/// one that goes on with the same velocity is a change point, through which the group passes into that mode.
///
/// Beyond a limit the configuration is open. A group comes back from there in the mode it had.
class Follower {
 public:
  Follower(const Mechanism& mechanism, const Structure& structure);

  /// The configuration at time `t` [s], before or after the one of the call before.
  const Configuration& advance(double t);

  /// As `advance`, but stops at the first limit on the way and says where. The configuration is then the last
  /// one before it, within 1e-10 rad of the fastest drive.
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
  enum class Verdict { good, too_far, blocked };
  enum class Crossing {
    passed,
    limit,
    amidst,  ///< the time asked for lies where the modes meet: it is in shown_
  };

  void start();
  void probe();
  void predict(double dt);
  Verdict attempt(double t);
  Verdict judge(std::size_t g, double dt) const;
  void accept(double t);
  Crossing step_towards(double t);
  Crossing cross(std::size_t g, double t);
  bool place_all(double t);
  void show(double t);
  bool passes(std::size_t g, double from, double to);
  double limit_between(std::size_t g, double inside, double outside);
  bool closes(std::size_t g, double t);
  bool try_to_return(double t);
  void copy_angles();

  Kinematics kinematics_;
  const Mechanism& mechanism_;
  DriveClock clock_;
  std::vector<Course> courses_;
  std::vector<double> regularities_;  ///< of the configuration attempted
  std::vector<DriveState> drives_, next_drives_;
  Configuration here_, next_, shown_;
  std::vector<double> angles_;  ///< continuous, of the last configuration that was not open
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

}  // namespace oblique
