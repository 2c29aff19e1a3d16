// SPDX-License-Identifier: MIT
#include <oblique/mechanism/configuration.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <oblique/mechanism/triangle.h>

namespace oblique {
namespace {

using Eigen::Vector2d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A triangle is flat where its slack is within this of its size. The coordinates of P and Q carry a few
/// roundings of their size each, and more behind several groups; 32 of them leave every angle between the
/// links whose sine is above about 2e-7 to the regular case.
constexpr double kFlatWithin = 32 * std::numeric_limits<double>::epsilon();

Vector2d left_normal(const Vector2d& v) {
  return {-v.y(), v.x()};
}

/// A body's turn as cosine and sine, about a point whose state is known.
struct Pose {
  std::size_t pivot;
  double cosine;
  double sine;
  double omega;
  double alpha;
};

void place_points(const Body& body, const Pose& pose, std::size_t keep, Configuration& configuration) {
  const PointState pivot = configuration.points[pose.pivot];
  const Vector2d& origin = body.find(pose.pivot)->local;
  for (const BodyPoint& p : body.points) {
    if (p.point == pose.pivot || p.point == keep) continue;
    const Vector2d local = p.local - origin;
    const Vector2d arm{pose.cosine * local.x() - pose.sine * local.y(),
                       pose.sine * local.x() + pose.cosine * local.y()};
    PointState& state = configuration.points[p.point];
    state.position = pivot.position + arm;
    state.velocity = pivot.velocity + pose.omega * left_normal(arm);
    state.acceleration = pivot.acceleration + pose.alpha * left_normal(arm) - pose.omega * pose.omega * arm;
  }
}

/// The pose that turns the body's own pivot → hinge into `arm`.
Pose pose_of(const Body& body, std::size_t pivot, std::size_t hinge, const Vector2d& arm, double omega,
             double alpha) {
  const Vector2d local = body.find(hinge)->local - body.find(pivot)->local;
  const double cosine = local.dot(arm);
  const double sine = local.x() * arm.y() - local.y() * arm.x();
  const double norm = std::hypot(cosine, sine);
  return {pivot, cosine / norm, sine / norm, omega, alpha};
}

void clear(const Mechanism& mechanism, Configuration& configuration) {
  const Vector2d nothing = Vector2d::Constant(kNaN);
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    if (!mechanism.points[i].fixed) configuration.points[i] = {nothing, nothing, nothing};
  }
  configuration.bodies.assign(mechanism.bodies.size(), {kNaN, kNaN, kNaN});
}

}  // namespace

std::string_view status_name(Status status) {
  constexpr std::array<std::string_view, 3> kNames{"ok", "dead-centre", "open"};
  return kNames[static_cast<std::size_t>(status)];
}

Configuration frame_configuration(const Mechanism& mechanism) {
  Configuration configuration;
  for (const Point& point : mechanism.points) {
    configuration.points.push_back({point.position, Vector2d::Zero(), Vector2d::Zero()});
  }
  clear(mechanism, configuration);
  return configuration;
}

Status place_crank(const Mechanism& mechanism, const CrankGroup& crank, double angle,
                   Configuration& configuration) {
  const double omega = mechanism.drives[crank.drive].speed;
  configuration.bodies[crank.body] = {angle, omega, 0};
  place_points(mechanism.bodies[crank.body], {crank.pivot, std::cos(angle), std::sin(angle), omega, 0},
               crank.pivot, configuration);
  return Status::ok;
}

Status place_dyad(const Mechanism& mechanism, const DyadGroup& dyad, Configuration& configuration) {
  const PointState p = configuration.points[dyad.p];
  const PointState q = configuration.points[dyad.q];
  const Vector2d d = q.position - p.position;
  const double base = std::hypot(d.x(), d.y());
  const Triangle shape = triangle(base, dyad.r1, dyad.r2);
  const double size = std::max(
      {dyad.r1 + dyad.r2, p.position.lpNorm<Eigen::Infinity>(), q.position.lpNorm<Eigen::Infinity>()});
  const double rounding = kFlatWithin * size;
  // P on Q: no C where r₁ ≠ r₂, and any direction of it where r₁ = r₂; neither gives a number. NaN ends here
  // too.
  if (!(base > rounding && shape.slack >= -rounding)) return Status::open;
  const bool flat = shape.slack <= rounding;

  const Vector2d e1 = (shape.along / base) * d + (dyad.side * shape.height / base) * left_normal(d);
  PointState& c = configuration.points[dyad.c];
  c.position = p.position + e1;
  const Vector2d e2 = c.position - q.position;

  double omega1 = kNaN, omega2 = kNaN, alpha1 = kNaN, alpha2 = kNaN;
  if (!flat) {
    const double cross = dyad.side * shape.four_area / 2;
    const Vector2d velocity = q.velocity - p.velocity;
    omega1 = e2.dot(velocity) / cross;
    omega2 = e1.dot(velocity) / cross;
    const Vector2d b = q.acceleration - p.acceleration + omega1 * omega1 * e1 - omega2 * omega2 * e2;
    alpha1 = e2.dot(b) / cross;
    alpha2 = e1.dot(b) / cross;
  }
  c.velocity = p.velocity + omega1 * left_normal(e1);
  c.acceleration = p.acceleration + alpha1 * left_normal(e1) - omega1 * omega1 * e1;

  const auto place_body = [&](std::size_t index, std::size_t pivot, const Vector2d& arm, double omega,
                              double alpha) {
    const Body& body = mechanism.bodies[index];
    const Pose pose = pose_of(body, pivot, dyad.c, arm, omega, alpha);
    configuration.bodies[index] = {std::atan2(pose.sine, pose.cosine), omega, alpha};
    place_points(body, pose, dyad.c, configuration);
  };
  place_body(dyad.body1, dyad.p, e1, omega1, alpha1);
  place_body(dyad.body2, dyad.q, e2, omega2, alpha2);
  return flat ? Status::dead_centre : Status::ok;
}

std::vector<double> drive_angles(const Mechanism& mechanism, double t) {
  std::vector<double> angles;
  for (const Drive& drive : mechanism.drives) angles.push_back(drive.start + drive.speed * t);
  return angles;
}

Configuration solve_configuration(const Mechanism& mechanism, const Structure& structure,
                                  std::span<const double> angles) {
  Configuration configuration = frame_configuration(mechanism);
  for (std::size_t i = 0; i < structure.groups.size(); ++i) {
    const Group& group = structure.groups[i];
    const auto* const crank = std::get_if<CrankGroup>(&group);
    const Status status = crank != nullptr
                              ? place_crank(mechanism, *crank, angles[crank->drive], configuration)
                              : place_dyad(mechanism, std::get<DyadGroup>(group), configuration);
    if (status == Status::ok) continue;
    if (!configuration.group || status == Status::open) configuration.group = i;
    configuration.status = status;
    if (status == Status::open) {
      clear(mechanism, configuration);
      break;
    }
  }
  return configuration;
}

}  // namespace oblique
