// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/structure/structure.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

constexpr double kTurn = 2 * std::numbers::pi;
/// Largest turn of a drive in a step.
constexpr double kDriveStep = std::numbers::pi / 180;
/// How far the fastest drive turns while limits are still told apart [rad].
constexpr double kSharpness = 1e-11;
/// Cosine of the largest turn of a body in a step, 30°.
constexpr double kBodyStep = 0.866;
/// Above this regularity a group is far from everything.
constexpr double kRegular = 0.25;
/// First correction by Newton's method, over the group's size, up to which a guess is nearly right; and the
/// part of it up to which the second one shows that no other mode lies as near.
constexpr double kGoodGuess = 0.02, kContracts = 0.25;

}  // namespace

Follower::Follower(const Mechanism& mechanism, const Structure& structure)
    : kinematics_(mechanism, structure),
      mechanism_(mechanism),
      clock_(mechanism),
      courses_(structure.groups.size()),
      regularities_(structure.groups.size(), 1),
      drives_(mechanism.drives.size()),
      next_drives_(mechanism.drives.size()),
      here_(frame_configuration(mechanism)),
      next_(here_),
      shown_(here_) {
  std::vector<double> rates;
  for (const Drive& drive : mechanism.drives) rates.push_back(drive.speed);
  set_pace(rates);
  for (std::size_t g = 0; g < courses_.size(); ++g) {
    courses_[g].side = structure.groups[g].side;
    tracks_ = tracks_ || kinematics_.solver(g).is_tracked();
  }
}

/// Follows the branch on which `from` stands while each drive goes straight on, at the rates `way`, from time
/// 0.
Follower::Follower(const Follower& other, const Standing& from, std::vector<double> way)
    : kinematics_(other.mechanism_, other.kinematics_.structure()),
      mechanism_(other.mechanism_),
      clock_(other.mechanism_),
      way_(std::move(way)),
      way_from_(from.drives),
      courses_(from.courses),
      regularities_(other.regularities_),
      drives_(from.drives),
      next_drives_(from.drives),
      here_(from.here),
      next_(from.here),
      shown_(from.here),
      angles_(from.angles),
      started_(true),
      tracks_(other.tracks_) {
  set_pace(way_);
  step_ = duration_of_degree_;
  place_all(0);
  accept(0);
  standing_ = standing();
  probe(1e-4 * duration_of_degree_);
}

/// Steps by the fastest of the drives' rates.
void Follower::set_pace(std::span<const double> rates) {
  double fastest = 0;
  for (std::size_t d = 0; d < rates.size(); ++d) {
    const double rate = std::abs(rates[d]);
    fastest = std::max(fastest, mechanism_.drives[d].slide ? rate / mechanism_.largest_length() : rate);
  }
  duration_of_degree_ = fastest > 0 ? kDriveStep / fastest : 1;
  smallest_ = fastest > 0 ? kSharpness / fastest : 1;
}

void Follower::drives_at(double t, std::vector<DriveState>& states) {
  if (way_.empty()) {
    clock_.at(t, states);
    return;
  }
  for (std::size_t d = 0; d < way_.size(); ++d) states[d] = {way_from_[d].value + t * way_[d], way_[d], 0};
}

void Follower::start() {
  kinematics_.load_start(next_);
  step_ = duration_of_degree_;
  open_ = !place_all(0);
  started_ = true;
  std::swap(here_, next_);
  std::swap(drives_, next_drives_);
  next_ = here_;
  time_ = 0;
  for (std::size_t g = 0; g < courses_.size(); ++g) {
    courses_[g].regularity = regularities_[g];
    courses_[g].peak = std::abs(regularities_[g]);
  }
  copy_angles();
  standing_ = standing();
  if (!open_) probe(1e-4 * duration_of_degree_);
}

/// The slopes of the regularities from a small step that is not made.
void Follower::probe(double dt) {
  for (Course& course : courses_) course.slope = 0;
  if (tracks_) predict(dt);
  if (attempt(time_ + dt) == Verdict::blocked) return;
  for (std::size_t g = 0; g < courses_.size(); ++g)
    courses_[g].slope = (regularities_[g] - courses_[g].regularity) / dt;
}

/// Taylor's formula as a guess of the positions a time `dt` on.
void Follower::predict(double dt) {
  next_.points = here_.points;
  next_.bodies = here_.bodies;
  const auto finite = [](double v) { return std::isfinite(v) ? v : 0.0; };
  for (PointState& point : next_.points) {
    const Vector2d way = dt * point.velocity + dt * dt / 2 * point.acceleration;
    if (way.allFinite()) point.position += way;
  }
  for (BodyState& body : next_.bodies) {
    const double angle = finite(dt * body.omega + dt * dt / 2 * body.alpha);
    const double c = std::cos(angle), s = std::sin(angle);
    const double cosine = c * body.cosine - s * body.sine;
    body.sine = s * body.cosine + c * body.sine;
    body.cosine = cosine;
  }
}

/// Puts the mechanism together at time `t`, in next_.
Follower::Verdict Follower::attempt(double t) {
  drives_at(t, next_drives_);
  next_.status = Status::ok;
  next_.group.reset();
  Verdict verdict = Verdict::good;
  for (std::size_t g = 0; g < courses_.size(); ++g) {
    GroupSolver& solver = kinematics_.solver(g);
    const Status status = solver.place(next_drives_, courses_[g].side, next_);
    regularities_[g] = solver.regularity();
    if (status == Status::open) {
      culprit_ = g;
      return Verdict::blocked;
    }
    if (status == Status::dead_centre) {  // no place to stand: without rates
      culprit_ = g;
      next_.group = g;
      next_.status = status;
      return Verdict::too_far;
    }
    if (verdict == Verdict::good && judge(g, t - time_) != Verdict::good) {
      culprit_ = g;
      verdict = Verdict::too_far;
    }
  }
  return verdict;
}

Follower::Verdict Follower::judge(std::size_t g, double dt) const {
  const Course& course = courses_[g];
  const double before = std::abs(course.regularity), after = std::abs(regularities_[g]);
  const bool same_sign = (course.regularity > 0) == (regularities_[g] > 0);
  if (!same_sign || after < before / 2) return Verdict::too_far;
  if (std::min(before, after) < kRegular &&
      (after > 2 * before || std::abs(course.slope * dt) > before / 2)) {
    return Verdict::too_far;
  }
  const GroupSolver& solver = kinematics_.solver(g);
  constexpr double kExact = 1e-7;  // a correction that is mostly rounding need not contract
  if (solver.is_tracked() && solver.correction() > kExact &&
      !(solver.correction() < kGoodGuess && solver.contraction() < kContracts)) {
    return Verdict::too_far;
  }
  for (const std::size_t body : kinematics_.structure().groups[g].bodies) {
    const BodyState& a = here_.bodies[body];
    const BodyState& b = next_.bodies[body];
    if (!(a.cosine * b.cosine + a.sine * b.sine > kBodyStep)) return Verdict::too_far;
  }
  return Verdict::good;
}

void Follower::accept(double t) {
  const double dt = t - time_;
  for (std::size_t g = 0; g < courses_.size(); ++g) {
    Course& course = courses_[g];
    if (dt != 0) course.slope = (regularities_[g] - course.regularity) / dt;
    course.regularity = regularities_[g];
    course.peak = std::max(course.peak, std::abs(course.regularity));
  }
  std::swap(here_, next_);
  std::swap(drives_, next_drives_);
  time_ = t;
  copy_angles();
}

/// Angles of the bodies, by the whole turns that come next to the last ones.
void Follower::copy_angles() {
  kinematics_.finish(drives_, here_);
  if (here_.status == Status::open) return;
  const bool first = angles_.empty();
  angles_.resize(here_.bodies.size());
  for (std::size_t b = 0; b < angles_.size(); ++b) {
    double& angle = here_.bodies[b].angle;
    if (!first && !mechanism_.drive_of(b)) angle += kTurn * std::round((angles_[b] - angle) / kTurn);
    angles_[b] = angle;
  }
}

/// Finishes what is shown for a time at which the follower itself does not stand.
void Follower::show(double t) {
  drives_at(t, next_drives_);
  kinematics_.finish(next_drives_, shown_);
  for (std::size_t b = 0; b < angles_.size(); ++b) {
    double& angle = shown_.bodies[b].angle;
    if (!mechanism_.drive_of(b)) angle += kTurn * std::round((angles_[b] - angle) / kTurn);
  }
}

/// No numbers at time `t`.
void Follower::show_open(double t, std::size_t group) {
  shown_ = here_;
  clear(mechanism_, shown_);
  shown_.status = Status::open;
  shown_.group = group;
  drives_at(t, next_drives_);
}

const Configuration& Follower::advance(double t) {
  if (!started_) start();
  while (time_ != t) {
    if (open_) {
      const std::size_t group = culprit_;
      if (!come_back(t)) {
        show_open(t, group);
        time_ = t;
        culprit_ = group;
        return shown_;
      }
      open_ = false;
      continue;
    }
    const std::size_t before = events_.size();
    const Crossing crossing = step_towards(t);
    if (crossing == Crossing::amidst) return shown_;
    if (crossing == Crossing::limit) {
      open_ = true;
      culprit_ = events_.back().group;
      if (stop_at_limit_) return here_;
      leave_branch();
    }
    if (stop_at_limit_ && events_.size() > before && events_.back().ends()) return here_;
  }
  return here_;
}

std::optional<MotionEvent> Follower::advance_to_limit(double t) {
  stop_at_limit_ = true;
  const std::size_t before = events_.size();
  advance(t);
  stop_at_limit_ = false;
  for (std::size_t i = before; i < events_.size(); ++i) {
    if (events_[i].ends() && std::abs(events_[i].time) <= std::abs(t)) return events_[i];
  }
  return std::nullopt;
}

}  // namespace oblique::mechanism
