// SPDX-License-Identifier: MIT
#include <oblique/mechanism/analysis/instant_centre.h>

#include <algorithm>
#include <cmath>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

constexpr double kEqual = 1e-12;

/// The velocity of a link at x is a + ω k×x.
struct Twist {
  Vector2d a = Vector2d::Zero();
  double omega = 0;
  double speed = 0;  ///< of its point [length unit/s], for comparison
};

Twist twist(const Mechanism& mechanism, const Configuration& here, std::size_t body) {
  const PointState& base = here.points[mechanism.bodies[body].points.front().point];
  const double omega = here.bodies[body].omega;
  return {base.velocity - omega * Vector2d(-base.position.y(), base.position.x()), omega,
          base.velocity.norm()};
}

/// A revolute joint that two links, or a link and the frame, share.
std::optional<std::size_t> shared_joint(const Mechanism& mechanism, std::optional<std::size_t> first,
                                        std::size_t second) {
  for (const BodyPoint& p : mechanism.bodies[second].points) {
    if (first ? mechanism.bodies[*first].find(p.point) != nullptr : mechanism.points[p.point].fixed) {
      return p.point;
    }
  }
  return std::nullopt;
}

InstantCentre centre_of(const Mechanism& mechanism, double size, const Configuration& here,
                        std::optional<std::size_t> first, std::size_t second) {
  InstantCentre centre{first, second, std::nullopt, std::nullopt};
  if (here.status == Status::open) return centre;
  if (const auto shared = shared_joint(mechanism, first, second)) {
    centre.position = here.points[*shared].position;
    return centre;
  }
  const Twist one = first ? twist(mechanism, here, *first) : Twist{};
  const Twist other = twist(mechanism, here, second);
  const double omega = other.omega - one.omega;
  const Vector2d relative = other.a - one.a;
  const double rate =
      std::max({std::abs(one.omega), std::abs(other.omega), one.speed / size, other.speed / size});
  if (!std::isfinite(omega) || !relative.allFinite()) return centre;
  // a₁ + ω₁ k×x = a₂ + ω₂ k×x  ⇒  x = k×(a₂ − a₁)/(ω₂ − ω₁)
  if (std::abs(omega) > kEqual * rate) {
    centre.position = Vector2d(-relative.y(), relative.x()) / omega;
  } else if (relative.norm() > kEqual * rate * size) {
    centre.direction = Vector2d(-relative.y(), relative.x()).normalized();
  }
  return centre;
}

}  // namespace

InstantCentre instant_centre(const Mechanism& mechanism, const Configuration& here,
                             std::optional<std::size_t> first, std::size_t second) {
  return centre_of(mechanism, mechanism.largest_length(), here, first, second);
}

std::vector<InstantCentre> instant_centres(const Mechanism& mechanism, const Configuration& here) {
  const double size = mechanism.largest_length();
  std::vector<InstantCentre> centres;
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    centres.push_back(centre_of(mechanism, size, here, std::nullopt, b));
  }
  for (std::size_t a = 0; a < mechanism.bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < mechanism.bodies.size(); ++b) {
      centres.push_back(centre_of(mechanism, size, here, a, b));
    }
  }
  return centres;
}

}  // namespace oblique::mechanism
