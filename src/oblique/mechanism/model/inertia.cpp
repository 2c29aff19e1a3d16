// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/inertia.h>

#include <algorithm>
#include <limits>

#include <oblique/text/quantity.h>

namespace oblique::mechanism {

bool has_masses(const Mechanism& mechanism) {
  return std::any_of(mechanism.bodies.begin(), mechanism.bodies.end(),
                     [](const Body& body) { return body.mass > 0; });
}

double length_in_metres(const Mechanism& mechanism) {
  return text::parse_unit(mechanism.length_unit).value().scale;
}

double bar_inertia(const Mechanism& mechanism, std::size_t body) {
  const Body& bar = mechanism.bodies[body];
  const double metre = length_in_metres(mechanism);
  const double length = metre * distance(bar, bar.points[0].point, bar.points[1].point);
  const double width = metre * bar.width;
  return bar.mass * (length * length + width * width) / 12;
}

double kinetic_energy(const Mechanism& mechanism, const Configuration& here) {
  const double metre = length_in_metres(mechanism);
  double twice = 0;
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    const Body& body = mechanism.bodies[b];
    if (body.mass == 0) continue;
    const Eigen::Vector2d velocity =
        metre * (here.points[body.points[0].point].velocity + here.points[body.points[1].point].velocity) / 2;
    const double omega = here.bodies[b].omega;
    twice += body.mass * velocity.squaredNorm() + bar_inertia(mechanism, b) * omega * omega;
  }
  return twice / 2;
}

double reduced_inertia(const Mechanism& mechanism, const Configuration& here, const DriveState& drive) {
  if (drive.rate == 0) return std::numeric_limits<double>::quiet_NaN();
  const double unit = mechanism.drives.front().slide ? length_in_metres(mechanism) : 1;
  const double rate = unit * drive.rate;
  return 2 * kinetic_energy(mechanism, here) / (rate * rate);
}

}  // namespace oblique::mechanism
