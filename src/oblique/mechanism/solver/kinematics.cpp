// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/kinematics.h>

#include <cmath>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

using Eigen::Vector2d;

Kinematics::Kinematics(const Mechanism& mechanism, const Structure& structure)
    : mechanism_(mechanism), structure_(structure) {
  solvers_.reserve(structure.groups.size());
  for (const Group& group : structure.groups) solvers_.emplace_back(mechanism, group);
  for (const Slide& slide : mechanism.slides) lines_.push_back(line_of(mechanism, slide));
}

void Kinematics::place(std::span<const DriveState> drives, Configuration& here) {
  here.status = Status::ok;
  here.group.reset();
  for (std::size_t g = 0; g < solvers_.size(); ++g) {
    const Status status = solvers_[g].place(drives, structure_.groups[g].side, here);
    if (status == Status::ok) continue;
    if (!here.group || status == Status::open) here.group = g;
    here.status = status;
    if (status == Status::open) {
      clear(mechanism_, here);
      return;
    }
  }
}

void Kinematics::finish(std::span<const DriveState> drives, Configuration& here) const {
  for (BodyState& body : here.bodies) body.angle = std::atan2(body.sine, body.cosine);
  for (std::size_t d = 0; d < mechanism_.drives.size(); ++d) {
    const Drive& drive = mechanism_.drives[d];
    if (!drive.slide && here.status != Status::open) here.bodies[drive.body].angle = drives[d].value;
  }
  for (std::size_t s = 0; s < lines_.size(); ++s) {
    const LineRef& line = lines_[s];
    const PointState& p = here.points[mechanism_.slides[s].point];
    Vector2d u = line.direction, way = p.position - line.point, rate = p.velocity, second = p.acceleration;
    double omega = 0, alpha = 0;
    if (line.kind != LineRef::Kind::fixed) {
      const BodyState& body = here.bodies[line.body];
      const PointState& base = here.points[mechanism_.bodies[line.body].points.front().point];
      const Vector2d arm = turned(line.point, body.cosine, body.sine);
      const Vector2d arm_left = left_normal(arm);
      omega = body.omega;
      alpha = body.alpha;
      u = turned(line.direction, body.cosine, body.sine);
      way = p.position - base.position - arm;
      rate -= base.velocity + omega * arm_left;
      second -= base.acceleration + alpha * arm_left - omega * omega * arm;
    }
    const Vector2d n = left_normal(u);
    here.slides[s] = {
        u.dot(way), u.dot(rate) + omega * n.dot(way),
        u.dot(second) + 2 * omega * n.dot(rate) + alpha * n.dot(way) - omega * omega * u.dot(way)};
  }
  for (std::size_t d = 0; d < mechanism_.drives.size(); ++d) {
    const Drive& drive = mechanism_.drives[d];
    if (drive.slide && here.status != Status::open)
      here.slides[*drive.slide] = {drives[d].value, drives[d].rate, drives[d].acceleration};
  }
}

void Kinematics::load_start(Configuration& here) const {
  for (const Group& group : structure_.groups) {
    for (std::size_t i = 0; i < group.start.platforms.size(); ++i) {
      const GroupPose::Platform& platform = group.start.platforms[i];
      const std::size_t body = group.equations.platforms[i];
      here.bodies[body].cosine = platform.cosine;
      here.bodies[body].sine = platform.sine;
      const std::size_t base = mechanism_.bodies[body].points.front().point;
      if (!mechanism_.points[base].fixed) here.points[base].position = platform.position;
    }
    for (std::size_t i = 0; i < group.start.points.size(); ++i)
      here.points[group.equations.free_points[i]].position = group.start.points[i];
  }
}

Configuration start_configuration(const Mechanism& mechanism, const Structure& structure) {
  std::vector<DriveState> drives(mechanism.drives.size());
  DriveClock(mechanism).at(0, drives);
  Kinematics kinematics(mechanism, structure);
  Configuration here = frame_configuration(mechanism);
  kinematics.load_start(here);
  kinematics.place(drives, here);
  kinematics.finish(drives, here);
  return here;
}

}  // namespace oblique::mechanism
