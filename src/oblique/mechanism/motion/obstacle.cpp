// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/obstacle.h>

#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

std::optional<Obstacle> find_obstacle(const Mechanism& mechanism, const Structure& structure) {
  const double turn = period(mechanism);
  check_travel(mechanism, turn);
  Follower follower(mechanism, structure);
  follower.advance(turn);
  if (follower.events().empty()) return std::nullopt;
  const MotionEvent& first = follower.events().front();
  return Obstacle{first.time, first.group, first.ends() ? Status::open : Status::dead_centre,
                  first.kind == MotionEvent::Kind::infinity};
}

}  // namespace oblique::mechanism
