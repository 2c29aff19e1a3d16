// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/branch_walk.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <oblique/mechanism/model/plane.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

/// Largest turn of a drive in a step.
constexpr double kDriveStep = std::numbers::pi / 180;
/// How far the fastest drive turns while limits are still told apart [rad].
constexpr double kSharpness = 1e-11;
/// Cosine of the largest turn of a link in a step, 30°.
constexpr double kBodyStep = 0.866;
/// Above this determinant a group is far from everything.
constexpr double kRegular = 0.25;
/// First correction by Newton's method, over the group's size, up to which a guess is nearly right; and the
/// part of it up to which the second one shows that no other mode lies as near.
constexpr double kGoodGuess = 0.02, kContracts = 0.25;

}  // namespace

BranchWalk::BranchWalk(const Mechanism& whole, const Structure& structure)
    : kinematics(whole, structure),
      mechanism(whole),
      clock(whole),
      courses(structure.groups.size()),
      determinants(structure.groups.size(), 1),
      drives(whole.drives.size()),
      next_drives(whole.drives.size()),
      here(frame_configuration(whole)),
      next(here),
      shown(here) {
  std::vector<double> rates;
  for (const Drive& drive : whole.drives) rates.push_back(drive.speed);
  set_pace(rates);
  for (std::size_t g = 0; g < courses.size(); ++g) {
    courses[g].side = structure.groups[g].side;
    tracks = tracks || kinematics.solver(g).is_tracked();
  }
}

BranchWalk::BranchWalk(const BranchWalk& other, const Place& from, std::vector<double> rates)
    : kinematics(other.mechanism, other.kinematics.structure()),
      mechanism(other.mechanism),
      clock(other.mechanism),
      straight(std::move(rates)),
      straight_from(from.drives),
      courses(from.courses),
      determinants(other.determinants),
      drives(from.drives),
      next_drives(from.drives),
      here(from.here),
      next(from.here),
      shown(from.here),
      angles(from.angles),
      started(true),
      tracks(other.tracks) {
  set_pace(straight);
  step = duration_of_degree;
  place_all(0);
  accept(0);
  last_clear = place();
  probe(1e-4 * duration_of_degree);
}

/// Steps by the fastest of the drives' rates.
void BranchWalk::set_pace(std::span<const double> rates) {
  double fastest = 0;
  for (std::size_t d = 0; d < rates.size(); ++d) {
    const double rate = std::abs(rates[d]);
    fastest = std::max(fastest, mechanism.drives[d].slide ? rate / mechanism.largest_length() : rate);
  }
  duration_of_degree = fastest > 0 ? kDriveStep / fastest : 1;
  smallest = fastest > 0 ? kSharpness / fastest : 1;
}

void BranchWalk::drives_at(double t, std::vector<DriveState>& states) {
  if (straight.empty()) {
    clock.at(t, states);
    return;
  }
  for (std::size_t d = 0; d < straight.size(); ++d)
    states[d] = {straight_from[d].value + t * straight[d], straight[d], 0};
}

void BranchWalk::start() {
  kinematics.load_start(next);
  step = duration_of_degree;
  is_open = !place_all(0);
  started = true;
  std::swap(here, next);
  std::swap(drives, next_drives);
  next = here;
  time = 0;
  for (std::size_t g = 0; g < courses.size(); ++g) {
    courses[g].determinant = determinants[g];
    courses[g].peak = std::abs(determinants[g]);
  }
  copy_angles();
  last_clear = place();
  if (!is_open) probe(1e-4 * duration_of_degree);
}

void BranchWalk::probe(double dt) {
  for (Course& course : courses) course.derivative = 0;
  if (tracks) predict(dt);
  if (attempt(time + dt) == Verdict::blocked) return;
  for (std::size_t g = 0; g < courses.size(); ++g)
    courses[g].derivative = (determinants[g] - courses[g].determinant) / dt;
}

void BranchWalk::predict(double dt) {
  next.points = here.points;
  next.bodies = here.bodies;
  const auto finite = [](double v) { return std::isfinite(v) ? v : 0.0; };
  for (PointState& point : next.points) {
    const Vector2d way = dt * point.velocity + dt * dt / 2 * point.acceleration;
    if (way.allFinite()) point.position += way;
  }
  for (BodyState& body : next.bodies) {
    const double angle = finite(dt * body.omega + dt * dt / 2 * body.alpha);
    const double c = std::cos(angle), s = std::sin(angle);
    const double cosine = c * body.cosine - s * body.sine;
    body.sine = s * body.cosine + c * body.sine;
    body.cosine = cosine;
  }
}

/// Puts the mechanism together at time `t`, in next.
BranchWalk::Verdict BranchWalk::attempt(double t) {
  drives_at(t, next_drives);
  next.status = Status::ok;
  next.group.reset();
  Verdict verdict = Verdict::good;
  for (std::size_t g = 0; g < courses.size(); ++g) {
    GroupSolver& solver = kinematics.solver(g);
    const Status status = solver.place(next_drives, courses[g].side, next);
    determinants[g] = solver.normalised_determinant();
    if (status == Status::open) {
      culprit = g;
      return Verdict::blocked;
    }
    if (status == Status::dead_centre) {  // no place to stand: without rates
      culprit = g;
      next.group = g;
      next.status = status;
      return Verdict::too_far;
    }
    if (verdict == Verdict::good && judge(g, t - time) != Verdict::good) {
      culprit = g;
      verdict = Verdict::too_far;
    }
  }
  return verdict;
}

BranchWalk::Verdict BranchWalk::judge(std::size_t g, double dt) const {
  const Course& course = courses[g];
  const double before = std::abs(course.determinant), after = std::abs(determinants[g]);
  const bool same_sign = (course.determinant > 0) == (determinants[g] > 0);
  if (!same_sign || after < before / 2) return Verdict::too_far;
  if (std::min(before, after) < kRegular &&
      (after > 2 * before || std::abs(course.derivative * dt) > before / 2)) {
    return Verdict::too_far;
  }
  const GroupSolver& solver = kinematics.solver(g);
  constexpr double kExact = 1e-7;  // a correction that is mostly rounding need not contract
  if (solver.is_tracked() && solver.correction() > kExact &&
      !(solver.correction() < kGoodGuess && solver.contraction() < kContracts)) {
    return Verdict::too_far;
  }
  for (const std::size_t body : kinematics.structure().groups[g].bodies) {
    const BodyState& a = here.bodies[body];
    const BodyState& b = next.bodies[body];
    if (!(a.cosine * b.cosine + a.sine * b.sine > kBodyStep)) return Verdict::too_far;
  }
  return Verdict::good;
}

void BranchWalk::accept(double t) {
  const double dt = t - time;
  for (std::size_t g = 0; g < courses.size(); ++g) {
    Course& course = courses[g];
    if (std::abs(dt) >= smallest) course.derivative = (determinants[g] - course.determinant) / dt;
    course.determinant = determinants[g];
    course.peak = std::max(course.peak, std::abs(course.determinant));
  }
  std::swap(here, next);
  std::swap(drives, next_drives);
  time = t;
  copy_angles();
}

void BranchWalk::copy_angles() {
  kinematics.finish(drives, here);
  if (here.status == Status::open) return;
  const bool first = angles.empty();
  angles.resize(here.bodies.size());
  for (std::size_t b = 0; b < angles.size(); ++b) {
    double& angle = here.bodies[b].angle;
    if (!first && !mechanism.drive_of(b)) angle += kTurn * std::round((angles[b] - angle) / kTurn);
    angles[b] = angle;
  }
}

void BranchWalk::show(double t) {
  drives_at(t, next_drives);
  kinematics.finish(next_drives, shown);
  for (std::size_t b = 0; b < angles.size(); ++b) {
    double& angle = shown.bodies[b].angle;
    if (!mechanism.drive_of(b)) angle += kTurn * std::round((angles[b] - angle) / kTurn);
  }
}

void BranchWalk::show_open(double t, std::size_t group) {
  shown = here;
  clear(mechanism, shown);
  shown.status = Status::open;
  shown.group = group;
  drives_at(t, next_drives);
}

/// All groups at time `t`, in next; false where one is open.
bool BranchWalk::place_all(double t) {
  if (started) predict(t - time);
  drives_at(t, next_drives);
  next.status = Status::ok;
  next.group.reset();
  for (std::size_t g = 0; g < courses.size(); ++g) {
    GroupSolver& solver = kinematics.solver(g);
    const Status status = solver.place(next_drives, courses[g].side, next);
    determinants[g] = solver.normalised_determinant();
    culprit = g;
    if (status == Status::open) return false;
    if (status == Status::dead_centre) {
      if (!next.group) next.group = g;
      next.status = status;
    }
  }
  return true;
}

}  // namespace oblique::mechanism
