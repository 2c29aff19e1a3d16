// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/closed_forms.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/triad/triad.h>
#include <oblique/mechanism/triad/triangle.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

double largest(const Vector2d& v) {
  return v.lpNorm<Eigen::Infinity>();
}

/// A circle or a line.
struct Locus {
  bool circle;
  Vector2d at, direction;
  double radius;
};

class ClosedForm {
 public:
  ClosedForm(const Mechanism& mechanism, const Group& group, std::span<const DriveState> drives,
             const Configuration& here, GroupState& state)
      : mechanism_(mechanism),
        form_(group.form),
        conditions_(group.equations.conditions),
        drives_(drives),
        here_(here),
        state_(state) {}

  Status find(int side) {
    switch (form_.placing) {
      case Placing::pinned:
        return find_pinned();
      case Placing::crossing:
        return find_crossing(side);
      case Placing::about_pivot:
        return find_about_pivot(side);
      case Placing::rotation:
      case Placing::triangle:
      case Placing::platform:
      case Placing::iteration:
        break;
    }
    throw std::logic_error("a group that is placed in another way");
  }

 private:
  const Condition& condition(const std::optional<std::size_t>& index) const {
    return conditions_[index.value()];
  }

  /// Where the unknown point lies: the free point, or the origin of the platform link, whose direction is
  /// known.
  Locus locus(const Condition& c) const {
    const auto arm = [&](const Vector2d& local) {
      return turned(local, state_.platforms.front().cosine, state_.platforms.front().sine);
    };
    const Vector2d shift = c.a.kind == PointRef::Kind::carried ? arm(c.a.local) : Vector2d::Zero();
    if (c.kind == Condition::Kind::distance) {
      return {true, here_.points[c.b.point].position - shift, Vector2d::Zero(), c.value};
    }
    const double along = c.kind == Condition::Kind::along ? drives_[*c.drive].value : 0;
    Locus line{false, {}, {}, 0};
    if (c.line.kind == LineRef::Kind::carried) {
      line.direction = arm(c.line.direction);
      line.at = here_.points[c.a.point].position - arm(c.line.point) - along * line.direction;
    } else {
      const LineState state_here = state_of(mechanism_, c.line, state_, here_);
      line.direction = state_here.direction;
      line.at = state_here.at.position + along * line.direction - shift;
    }
    if (c.kind == Condition::Kind::along) line.direction = left_normal(line.direction);
    return line;
  }

  /// The direction of the unknown link, where there is one.
  void set_direction() {
    if (state_.platforms.empty()) return;
    const Condition& c = condition(form_.angle);
    const double angle = c.drive ? drives_[*c.drive].value : c.value;
    Vector2d axis = Vector2d::UnitX();
    if (c.line.kind == LineRef::Kind::known)
      axis = {here_.bodies[c.line.body].cosine, here_.bodies[c.line.body].sine};
    const Vector2d direction = turned(axis, std::cos(angle), std::sin(angle));
    state_.platforms.front().cosine = direction.x();
    state_.platforms.front().sine = direction.y();
  }

  Status find_pinned() {
    set_direction();
    const Condition& c = condition(form_.revolute);
    GroupState::Platform& platform = state_.platforms.front();
    platform.origin.position =
        here_.points[c.b.point].position - turned(c.a.local, platform.cosine, platform.sine);
    return std::isfinite(platform.origin.position.x()) ? Status::ok : Status::open;
  }

  /// Two circles: the triangle over their centres, on the left of first → second for `side` +1. A circle and
  /// a line: the foot of the centre on the line, and half the chord from there, forwards for +1. Two lines:
  /// Cramer.
  Status find_crossing(int side) {
    set_direction();
    Vector2d& unknown =
        state_.platforms.empty() ? state_.free.front().position : state_.platforms.front().origin.position;
    const Locus first = locus(conditions_[form_.loci[0]]);
    const Locus second = locus(conditions_[form_.loci[1]]);
    const double rounding =
        flat_within(std::max({first.radius + second.radius, largest(first.at), largest(second.at)}));
    if (first.circle && second.circle) {
      const Vector2d d = second.at - first.at;
      const double base = std::hypot(d.x(), d.y());
      const Triangle shape = triangle(base, first.radius, second.radius);
      if (!(base > rounding && shape.slack >= -rounding)) return Status::open;
      unknown = first.at + (shape.along / base) * d + (side * shape.height / base) * left_normal(d);
      return shape.slack > rounding ? Status::ok : Status::dead_centre;
    }
    if (first.circle) {
      const Vector2d way = first.at - second.at;
      const double height = cross(second.direction, way);
      const double slack = first.radius - std::abs(height);
      if (!(slack >= -rounding)) return Status::open;
      const double half = slack > 0 ? std::sqrt(slack * (first.radius + std::abs(height))) : 0;
      unknown = second.at + (second.direction.dot(way) + side * half) * second.direction;
      return slack > rounding ? Status::ok : Status::dead_centre;
    }
    // the sine of the angle between the guides; within rounding they are parallel
    const double sine = cross(first.direction, second.direction);
    constexpr double kParallel = 1e-14;
    if (!(std::abs(sine) > kParallel)) return Status::open;
    unknown = first.at + cross(second.at - first.at, second.direction) / sine * first.direction;
    return Status::ok;
  }

  /// a cos θ + b sin θ = c for a link pinned to a known point P: with m from the revolute joint in the link's
  /// frame and w from P in the world's,
  ///
  ///     distance to a known point     w·R m = (m² + w² − r²)/2
  ///     known point on its own line   w·R n = n·m
  ///     its point on a known line     n·R m = n·(A − P)
  ///
  /// θ is the direction of (a, b), ± arccos(c/√(a² + b²)), left for `side` +1.
  Status find_about_pivot(int side) {
    const Condition& revolute = condition(form_.revolute);
    const Condition& c = conditions_[form_.loci.front()];
    const Vector2d p = here_.points[revolute.b.point].position;
    Vector2d m, w;
    double constant = 0;
    const bool along = c.kind == Condition::Kind::along;
    const double way = along ? drives_[*c.drive].value : 0;
    if (c.kind == Condition::Kind::distance) {
      m = c.a.local - revolute.a.local;
      w = here_.points[c.b.point].position - p;
      constant = (m.squaredNorm() + w.squaredNorm() - c.value * c.value) / 2;
    } else if (c.line.kind == LineRef::Kind::carried) {
      m = along ? c.line.direction : left_normal(c.line.direction);
      w = here_.points[c.a.point].position - p;
      constant = m.dot(c.line.point - revolute.a.local) + way;
    } else {
      const LineState line = state_of(mechanism_, c.line, state_, here_);
      m = c.a.local - revolute.a.local;
      w = along ? line.direction : left_normal(line.direction);
      constant = w.dot(line.at.position - p) + way;
    }
    const double a = w.dot(m), b = cross(m, w);
    const double norm = std::hypot(a, b);
    const double rounding = flat_within(std::max({norm, std::abs(constant), largest(p) * m.norm()}));
    const double slack = norm - std::abs(constant);
    if (!(norm > rounding && slack >= -rounding)) return Status::open;
    const double cosine = std::clamp(constant / norm, -1.0, 1.0);
    const double sine = slack > 0 ? side * std::sqrt(slack * (norm + std::abs(constant))) / norm : 0;
    GroupState::Platform& platform = state_.platforms.front();
    platform.cosine = (cosine * a - sine * b) / norm;
    platform.sine = (cosine * b + sine * a) / norm;
    platform.origin.position = p - turned(revolute.a.local, platform.cosine, platform.sine);
    return slack > rounding ? Status::ok : Status::dead_centre;
  }

  const Mechanism& mechanism_;
  const GroupForm& form_;
  const std::vector<Condition>& conditions_;
  std::span<const DriveState> drives_;
  const Configuration& here_;
  GroupState& state_;
};

}  // namespace

Status find_by_closed_form(const Mechanism& mechanism, const Group& group, std::span<const DriveState> drives,
                           int side, const Configuration& here, GroupState& state) {
  return ClosedForm(mechanism, group, drives, here, state).find(side);
}

GroupPoses platform_poses(const Mechanism& mechanism, const Group& group, const Configuration& here) {
  GroupPoses found;
  std::array<Leg, 3> legs;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Condition& c = group.equations.conditions[group.form.loci[i]];
    Leg& leg = legs[i];
    leg.length = c.value;
    if (c.kind == Condition::Kind::distance) {
      leg.kind = Leg::Kind::circle;
      leg.local = c.a.local;
      leg.anchor = here.points[c.b.point].position;
    } else if (c.line.kind == LineRef::Kind::carried) {
      leg.kind = Leg::Kind::platform_line;
      leg.local = c.line.point;
      leg.direction = c.line.direction;
      leg.anchor = here.points[c.a.point].position;
    } else {
      const LineState line = state_of(mechanism, c.line, GroupState(group.equations), here);
      leg.kind = Leg::Kind::fixed_line;
      leg.local = c.a.local;
      leg.anchor = line.at.position;
      leg.direction = line.direction;
    }
    if (!std::isfinite(leg.anchor.x())) return found;
  }
  const PlatformModes modes = platform_modes(legs);
  found.movable = modes.movable;
  for (int i = 0; i < modes.count; ++i) {
    const PlatformPose& platform = modes.poses[static_cast<std::size_t>(i)];
    GroupPose pose;
    pose.platforms.push_back({platform.position, platform.cosine, platform.sine});
    found.poses.push_back(std::move(pose));
  }
  return found;
}

}  // namespace oblique::mechanism
