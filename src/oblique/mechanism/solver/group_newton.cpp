// SPDX-License-Identifier: MIT
// The part of GroupSolver that writes its conditions and their derivatives down and solves them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/LU>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/solver/group_solver.h>

namespace oblique::mechanism {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// A point of a body whose base moves like this.
PointState carried(const PointState& base, const Vector2d& way, double omega, double alpha) {
  return {base.position + way, base.velocity + omega * left_normal(way),
          base.acceleration + alpha * left_normal(way) - omega * omega * way};
}

}  // namespace

PointState GroupSolver::state(const PointRef& point, const Configuration& here) const {
  if (point.kind == PointRef::Kind::known) return here.points[point.point];
  if (point.kind == PointRef::Kind::free) return free_[point.member];
  const Core& core = cores_[point.member];
  return carried(core.origin, turned(point.local, core.cosine, core.sine), core.omega, core.alpha);
}

GroupSolver::LineState GroupSolver::state(const LineRef& line, const Configuration& here) const {
  if (line.kind == LineRef::Kind::fixed) {
    return {{line.point, Vector2d::Zero(), Vector2d::Zero()}, line.direction, 0, 0};
  }
  if (line.kind == LineRef::Kind::carried) {
    const Core& core = cores_[line.member];
    return {carried(core.origin, turned(line.point, core.cosine, core.sine), core.omega, core.alpha),
            turned(line.direction, core.cosine, core.sine), core.omega, core.alpha};
  }
  const BodyState& body = here.bodies[line.body];
  const PointState& base = here.points[mechanism_.bodies[line.body].points.front().point];
  return {carried(base, turned(line.point, body.cosine, body.sine), body.omega, body.alpha),
          turned(line.direction, body.cosine, body.sine), body.omega, body.alpha};
}

/// right_ = −g.
void GroupSolver::evaluate(std::span<const DriveState> drives, const Configuration& here) {
  using Kind = Condition::Kind;
  Index row = 0;
  for (const Condition& c : equations_.conditions) {
    switch (c.kind) {
      case Kind::distance: {
        const Vector2d d = state(c.a, here).position - state(c.b, here).position;
        // (|d|² − r²)/2r = (|d| − r)(|d| + r)/2r, without cancelling squares
        const double length = std::sqrt(d.squaredNorm());
        right_(row++) = (c.value - length) * (length + c.value) / (2 * c.value);
        break;
      }
      case Kind::coincidence: {
        const Vector2d d = state(c.a, here).position - state(c.b, here).position;
        right_(row++) = -d.x();
        right_(row++) = -d.y();
        break;
      }
      case Kind::on_line:
      case Kind::along: {
        const LineState line = state(c.line, here);
        const Vector2d d = state(c.a, here).position - line.at.position;
        right_(row++) = c.kind == Kind::on_line ? -left_normal(line.direction).dot(d)
                                                : drives[*c.drive].value - line.direction.dot(d);
        break;
      }
      case Kind::orientation: {
        const Core& core = cores_[c.member];
        // where the carrier's x axis points, or the drive
        double cosine = 1, sine = 0;
        if (c.line.kind == LineRef::Kind::carried) {
          cosine = cores_[c.line.member].cosine;
          sine = cores_[c.line.member].sine;
        } else if (c.line.kind == LineRef::Kind::known) {
          cosine = here.bodies[c.line.body].cosine;
          sine = here.bodies[c.line.body].sine;
        }
        const double angle = c.drive ? drives[*c.drive].value : c.value;
        const Vector2d wanted = turned({cosine, sine}, std::cos(angle), std::sin(angle));
        const double across = wanted.x() * core.sine - wanted.y() * core.cosine;
        const double along = wanted.x() * core.cosine + wanted.y() * core.sine;
        right_(row++) = -size_ * (along > 0 ? across : std::atan2(across, along));
        break;
      }
    }
  }
}

/// Rows as in `equations_.conditions`; angles are counted as lengths on the group's size.
void GroupSolver::evaluate_jacobian(const Configuration& here) {
  using Kind = Condition::Kind;
  jacobian_.setZero();
  Index row = 0;
  const auto free_column = [&](std::size_t member) {
    return static_cast<Index>(3 * cores_.size() + 2 * member);
  };
  /// Adds `slope`, the derivative by the position of a point, as the chain rule has it.
  const auto add = [&](Index r, const PointRef& point, const Vector2d& slope) {
    if (point.kind == PointRef::Kind::known) return;
    Index column = free_column(point.member);
    if (point.kind == PointRef::Kind::carried) {
      const Core& core = cores_[point.member];
      column = static_cast<Index>(3 * point.member);
      jacobian_(r, column + 2) += slope.dot(left_normal(turned(point.local, core.cosine, core.sine))) / size_;
    }
    jacobian_(r, column) += slope.x();
    jacobian_(r, column + 1) += slope.y();
  };
  for (const Condition& c : equations_.conditions) {
    switch (c.kind) {
      case Kind::distance: {
        const Vector2d slope = (state(c.a, here).position - state(c.b, here).position) / c.value;
        add(row, c.a, slope);
        add(row++, c.b, -slope);
        break;
      }
      case Kind::coincidence:
        add(row, c.a, Vector2d::UnitX());
        add(row++, c.b, -Vector2d::UnitX());
        add(row, c.a, Vector2d::UnitY());
        add(row++, c.b, -Vector2d::UnitY());
        break;
      case Kind::on_line:
      case Kind::along: {
        const LineState line = state(c.line, here);
        const Vector2d d = state(c.a, here).position - line.at.position;
        const Vector2d normal = left_normal(line.direction);
        const Vector2d slope = c.kind == Kind::on_line ? normal : line.direction;
        add(row, c.a, slope);
        if (c.line.kind == LineRef::Kind::carried) {
          const PointRef at{PointRef::Kind::carried, 0, c.line.member, c.line.point};
          add(row, at, -slope);
          const double turn = c.kind == Kind::on_line ? -line.direction.dot(d) : normal.dot(d);
          jacobian_(row, static_cast<Index>(3 * c.line.member + 2)) += turn / size_;
        }
        ++row;
        break;
      }
      case Kind::orientation:
        jacobian_(row, static_cast<Index>(3 * c.member + 2)) += 1;
        if (c.line.kind == LineRef::Kind::carried)
          jacobian_(row, static_cast<Index>(3 * c.line.member + 2)) -= 1;
        ++row;
        break;
    }
  }
}

/// right_ = −dg/dt with q̇ = 0, or (`second`) −d²g/dt² with q̈ = 0.
///
///     distance  g' = d·d'/r                     g'' = (d·d'' + d'²)/r
///     on_line   g' = n·d' − ω u·d               g'' = n·d'' − 2ω u·d' − α u·d − ω² n·d
///     along     g' = u·d' + ω n·d − s'          g'' = u·d'' + 2ω n·d' + α n·d − ω² u·d − s''
void GroupSolver::evaluate_rates(std::span<const DriveState> drives, const Configuration& here, bool second) {
  using Kind = Condition::Kind;
  Index row = 0;
  for (const Condition& c : equations_.conditions) {
    switch (c.kind) {
      case Kind::distance:
      case Kind::coincidence: {
        const PointState a = state(c.a, here), b = state(c.b, here);
        const Vector2d d = a.position - b.position;
        const Vector2d d1 = a.velocity - b.velocity;
        const Vector2d d2 = a.acceleration - b.acceleration;
        if (c.kind == Kind::distance) {
          right_(row++) = -(second ? d.dot(d2) + d1.squaredNorm() : d.dot(d1)) / c.value;
        } else {
          right_(row++) = -(second ? d2 : d1).x();
          right_(row++) = -(second ? d2 : d1).y();
        }
        break;
      }
      case Kind::on_line:
      case Kind::along: {
        const PointState a = state(c.a, here);
        const LineState line = state(c.line, here);
        const Vector2d& u = line.direction;
        const Vector2d n = left_normal(u);
        const Vector2d d = a.position - line.at.position;
        const Vector2d d1 = a.velocity - line.at.velocity;
        const Vector2d d2 = a.acceleration - line.at.acceleration;
        const double w = line.omega;
        if (c.kind == Kind::on_line) {
          right_(row++) = second ? -(n.dot(d2) - 2 * w * u.dot(d1) - line.alpha * u.dot(d) - w * w * n.dot(d))
                                 : -(n.dot(d1) - w * u.dot(d));
        } else {
          const DriveState& drive = drives[*c.drive];
          right_(row++) = second ? drive.acceleration - (u.dot(d2) + 2 * w * n.dot(d1) +
                                                         line.alpha * n.dot(d) - w * w * u.dot(d))
                                 : drive.rate - (u.dot(d1) + w * n.dot(d));
        }
        break;
      }
      case Kind::orientation: {
        double rate = 0;
        if (c.line.kind == LineRef::Kind::known) {
          const BodyState& body = here.bodies[c.line.body];
          rate = second ? body.alpha : body.omega;
        }
        if (c.drive) rate += second ? drives[*c.drive].acceleration : drives[*c.drive].rate;
        right_(row++) = size_ * rate;
        break;
      }
    }
  }
}

/// solution_ = jacobian_⁻¹ right_; false where there is none.
bool GroupSolver::solve() {
  if (jacobian_.rows() == 2) {
    const Eigen::Matrix2d j = jacobian_;
    determinant_ = j.determinant();
    solution_ = j.inverse() * right_;
  } else if (jacobian_.rows() == 3) {
    const Eigen::Matrix3d j = jacobian_;
    determinant_ = j.determinant();
    solution_ = j.inverse() * right_;
  } else {
    const Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> lu(work_ = jacobian_);
    determinant_ = lu.determinant();
    solution_ = lu.solve(right_);
  }
  return determinant_ != 0 && solution_.allFinite();
}

void GroupSolver::measure_regularity() {
  double lengths = 1;
  for (Index row = 0; row < jacobian_.rows(); ++row) lengths *= jacobian_.row(row).norm();
  regularity_ = determinant_ / lengths;
}

bool GroupSolver::newton(std::span<const DriveState> drives, const Configuration& here, double longest_step) {
  constexpr int kMostSteps = 60;
  // Errors are squared from step to step: after one this small the next would be rounding.
  constexpr double kLastStep = 1e-9;
  double before = std::numeric_limits<double>::infinity();
  contraction_ = 0;
  double largest = size_;
  for (const Core& core : cores_) largest = std::max(largest, core.origin.position.lpNorm<Eigen::Infinity>());
  for (const PointState& point : free_) largest = std::max(largest, point.position.lpNorm<Eigen::Infinity>());
  const double rounding = 64 * std::numeric_limits<double>::epsilon() * largest;
  for (int step = 0; step < kMostSteps; ++step) {
    evaluate(drives, here);
    evaluate_jacobian(here);
    if (!solve()) return false;
    double length = solution_.lpNorm<Eigen::Infinity>();
    if (step == 0) correction_ = length / size_;
    if (step == 1) contraction_ = length / before;
    // a step that is too long is shortened, so that the search does not leap into the far
    const double most = longest_step * size_;
    const double factor = length > most ? most / length : 1;
    Index k = 0;
    for (Core& core : cores_) {
      core.origin.position += factor * solution_.segment<2>(k);
      const double angle = factor * solution_(k + 2) / size_;
      const double c = core.cosine - angle * core.sine;
      const double s = core.sine + angle * core.cosine;
      const double norm = 1 / std::sqrt(c * c + s * s);
      core.cosine = c * norm;
      core.sine = s * norm;
      k += 3;
    }
    for (PointState& point : free_) {
      point.position += factor * solution_.segment<2>(k);
      k += 2;
    }
    if (length <= std::max(kLastStep * size_, rounding)) return true;
    // at a double root the steps only halve, down to the root of the rounding
    if (step > 20 && length > 0.9 * before && factor == 1) break;
    before = length;
  }
  evaluate(drives, here);
  return right_.lpNorm<Eigen::Infinity>() <= rounding;
}

std::optional<GroupPose> GroupSolver::close(std::span<const DriveState> drives, const Configuration& here,
                                            const GroupPose& guess) {
  load(guess);
  constexpr double kFarthest = 0.5;
  if (!newton(drives, here, kFarthest)) return std::nullopt;
  return pose(guess.side);
}

void GroupSolver::search(std::span<const DriveState> drives, const Configuration& here, const GroupPose* hint,
                         GroupPoses& found) {
  found.complete = false;
  const auto is_new = [&](const GroupPose& pose) {
    constexpr double kSame = 1e-6;
    return std::none_of(found.poses.begin(), found.poses.end(), [&](const GroupPose& other) {
      double far = 0;
      for (std::size_t i = 0; const GroupPose::Core& core : pose.cores) {
        const GroupPose::Core& twin = other.cores[i++];
        far = std::max(far, (core.position - twin.position).norm());
        far = std::max(far, size_ * std::hypot(core.cosine - twin.cosine, core.sine - twin.sine));
      }
      for (std::size_t i = 0; const Vector2d& point : pose.points)
        far = std::max(far, (point - other.points[i++]).norm());
      return far < kSame * size_;
    });
  };
  const auto attempt = [&](const GroupPose& guess) {
    const auto closed = close(drives, here, guess);
    if (closed && is_new(*closed)) found.poses.push_back(*closed);
  };
  if (hint != nullptr) attempt(*hint);
  // the box of the known points, with the group's size around it
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Condition& c : equations_.conditions) {
    for (const PointRef* point : {&c.a, &c.b}) {
      if (point->kind != PointRef::Kind::known || c.kind == Condition::Kind::orientation) continue;
      if (point == &c.b && c.kind != Condition::Kind::distance && c.kind != Condition::Kind::coincidence)
        continue;
      low = low.cwiseMin(here.points[point->point].position);
      high = high.cwiseMax(here.points[point->point].position);
    }
  }
  if (!(low.x() <= high.x())) low = high = Vector2d::Zero();
  low.array() -= size_;
  high.array() += size_;
  std::mt19937_64 random(20211121);
  const auto fraction = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto place_in_box = [&] {
    return Vector2d(low.x() + fraction() * (high.x() - low.x()), low.y() + fraction() * (high.y() - low.y()));
  };
  const int starts = 60 * static_cast<int>(equations_.unknowns());
  for (int i = 0; i < starts; ++i) {
    GroupPose guess;
    guess.cores.resize(cores_.size());
    for (GroupPose::Core& core : guess.cores) {
      const double angle = 2 * std::numbers::pi * fraction();
      core = {place_in_box(), std::cos(angle), std::sin(angle)};
    }
    guess.points.resize(free_.size());
    for (Vector2d& point : guess.points) point = place_in_box();
    attempt(guess);
  }
}

}  // namespace oblique::mechanism
