// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/group_system.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include <oblique/mechanism/model/plane.h>

namespace oblique::mechanism {

using Eigen::Index;
using Eigen::Vector2d;

namespace {

double size_of(const Mechanism& mechanism, const GroupEquations& equations) {
  double size = 0, offset = 0;
  for (const Condition& c : equations.conditions) {
    if (c.kind == Condition::Kind::distance) size = std::max(size, c.value);
    for (const PointRef* point : {&c.a, &c.b}) size = std::max(size, point->local.norm());
    if (c.line.kind != LineRef::Kind::fixed) offset = std::max(offset, c.line.point.norm());
  }
  // Of what slides along a line on a body alone the offset says nothing of how far it is from there.
  if (size == 0) size = mechanism.largest_length();
  return std::max({size, offset, std::numeric_limits<double>::min()});
}

}  // namespace

GroupSystem::GroupSystem(const Mechanism& mechanism, const GroupEquations& equations)
    : mechanism_(mechanism), equations_(equations), size_(size_of(mechanism, equations)) {
  const auto n = static_cast<Index>(equations_.unknowns());
  jacobian_.setZero(n, n);
  work_.setZero(n, n);
  right_.setZero(n);
  solution_.setZero(n);
}

void GroupSystem::evaluate(const GroupState& state, std::span<const DriveState> drives,
                           const Configuration& here) {
  using Kind = Condition::Kind;
  Index row = 0;
  for (const Condition& c : equations_.conditions) {
    switch (c.kind) {
      case Kind::distance: {
        const Vector2d d = state_of(c.a, state, here).position - state_of(c.b, state, here).position;
        // (|d|² − r²)/2r = (|d| − r)(|d| + r)/2r, without cancelling squares
        const double length = std::sqrt(d.squaredNorm());
        right_(row++) = (c.value - length) * (length + c.value) / (2 * c.value);
        break;
      }
      case Kind::coincidence: {
        const Vector2d d = state_of(c.a, state, here).position - state_of(c.b, state, here).position;
        right_(row++) = -d.x();
        right_(row++) = -d.y();
        break;
      }
      case Kind::on_line:
      case Kind::along: {
        const LineState line = state_of(mechanism_, c.line, state, here);
        const Vector2d d = state_of(c.a, state, here).position - line.at.position;
        right_(row++) = c.kind == Kind::on_line ? -left_normal(line.direction).dot(d)
                                                : drives[*c.drive].value - line.direction.dot(d);
        break;
      }
      case Kind::orientation: {
        const GroupState::Platform& platform = state.platforms[c.member];
        // where the carrier's x axis points, or the drive
        double cosine = 1, sine = 0;
        if (c.line.kind == LineRef::Kind::carried) {
          cosine = state.platforms[c.line.member].cosine;
          sine = state.platforms[c.line.member].sine;
        } else if (c.line.kind == LineRef::Kind::known) {
          cosine = here.bodies[c.line.body].cosine;
          sine = here.bodies[c.line.body].sine;
        }
        const double angle = c.drive ? drives[*c.drive].value : c.value;
        const Vector2d wanted = turned({cosine, sine}, std::cos(angle), std::sin(angle));
        const double across = wanted.x() * platform.sine - wanted.y() * platform.cosine;
        const double along = wanted.x() * platform.cosine + wanted.y() * platform.sine;
        right_(row++) = -size_ * (along > 0 ? across : std::atan2(across, along));
        break;
      }
    }
  }
}

void GroupSystem::evaluate_jacobian(const GroupState& state, const Configuration& here) {
  using Kind = Condition::Kind;
  jacobian_.setZero();
  Index row = 0;
  const auto free_column = [&](std::size_t member) {
    return static_cast<Index>(3 * state.platforms.size() + 2 * member);
  };
  /// Adds the derivative by the position of a point, as the chain rule has it.
  const auto add = [&](Index r, const PointRef& point, const Vector2d& derivative) {
    if (point.kind == PointRef::Kind::known) return;
    Index column = free_column(point.member);
    if (point.kind == PointRef::Kind::carried) {
      const GroupState::Platform& platform = state.platforms[point.member];
      column = static_cast<Index>(3 * point.member);
      jacobian_(r, column + 2) +=
          derivative.dot(left_normal(turned(point.local, platform.cosine, platform.sine))) / size_;
    }
    jacobian_(r, column) += derivative.x();
    jacobian_(r, column + 1) += derivative.y();
  };
  for (const Condition& c : equations_.conditions) {
    switch (c.kind) {
      case Kind::distance: {
        const Vector2d derivative =
            (state_of(c.a, state, here).position - state_of(c.b, state, here).position) / c.value;
        add(row, c.a, derivative);
        add(row++, c.b, -derivative);
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
        const LineState line = state_of(mechanism_, c.line, state, here);
        const Vector2d d = state_of(c.a, state, here).position - line.at.position;
        const Vector2d normal = left_normal(line.direction);
        const Vector2d derivative = c.kind == Kind::on_line ? normal : line.direction;
        add(row, c.a, derivative);
        if (c.line.kind == LineRef::Kind::carried) {
          const PointRef at{PointRef::Kind::carried, 0, c.line.member, c.line.point};
          add(row, at, -derivative);
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

///     distance  g' = d·d'/r                     g'' = (d·d'' + d'²)/r
///     on_line   g' = n·d' − ω u·d               g'' = n·d'' − 2ω u·d' − α u·d − ω² n·d
///     along     g' = u·d' + ω n·d − s'          g'' = u·d'' + 2ω n·d' + α n·d − ω² u·d − s''
void GroupSystem::evaluate_rates(const GroupState& state, std::span<const DriveState> drives,
                                 const Configuration& here, bool second) {
  using Kind = Condition::Kind;
  Index row = 0;
  for (const Condition& c : equations_.conditions) {
    switch (c.kind) {
      case Kind::distance:
      case Kind::coincidence: {
        const PointState a = state_of(c.a, state, here), b = state_of(c.b, state, here);
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
        const PointState a = state_of(c.a, state, here);
        const LineState line = state_of(mechanism_, c.line, state, here);
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

bool GroupSystem::solve() {
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

double GroupSystem::normalised_determinant() const {
  // The determinant is the same whichever point of a body its place is told of, the lengths of the rows are
  // not: a lever may be as long as the way to a body that is far away, which says nothing of its modes.
  constexpr double kLongestLever = 4;  // sizes; of conditions within the reach of the links it is about 1
  const auto levers = static_cast<Index>(3 * equations_.platforms.size());
  double lengths = 1;
  for (Index row = 0; row < jacobian_.rows(); ++row) {
    double squares = 0;
    for (Index column = 0; column < jacobian_.cols(); ++column) {
      const double part = std::abs(jacobian_(row, column));
      const double counted = column < levers && column % 3 == 2 ? std::min(part, kLongestLever) : part;
      squares += counted * counted;
    }
    lengths *= std::sqrt(squares);
  }
  return determinant_ / lengths;
}

}  // namespace oblique::mechanism
