// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/configuration.h>

#include <array>
#include <limits>

namespace oblique::mechanism {

std::string_view status_name(Status status) {
  constexpr std::array<std::string_view, 3> kNames{"ok", "dead-centre", "open"};
  return kNames[static_cast<std::size_t>(status)];
}

Configuration frame_configuration(const Mechanism& mechanism) {
  Configuration configuration;
  for (const Point& point : mechanism.points) {
    configuration.points.push_back({point.position, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()});
  }
  clear(mechanism, configuration);
  return configuration;
}

void clear(const Mechanism& mechanism, Configuration& configuration) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector2d nothing = Eigen::Vector2d::Constant(kUnknown);
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    if (!mechanism.points[i].fixed) configuration.points[i] = {nothing, nothing, nothing};
  }
  configuration.bodies.assign(mechanism.bodies.size(), {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown});
  configuration.slides.assign(mechanism.slides.size(), {kUnknown, kUnknown, kUnknown});
}

void turn_back(Configuration& configuration) {
  for (PointState& point : configuration.points) point.velocity = -point.velocity;
  for (BodyState& body : configuration.bodies) body.omega = -body.omega;
  for (SlideState& slide : configuration.slides) slide.velocity = -slide.velocity;
}

}  // namespace oblique::mechanism
