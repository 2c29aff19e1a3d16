// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/follower.h>

#include <oblique/mechanism/motion/crossings.h>

namespace oblique::mechanism {

Follower::Follower(const Mechanism& mechanism, const Structure& structure) : walk_(mechanism, structure) {}

const Configuration& Follower::advance(double t) {
  if (!walk_.started) walk_.start();
  while (walk_.time != t) {
    if (walk_.is_open) {
      const std::size_t group = walk_.culprit;
      if (!gap_ || !come_back(walk_, *gap_, t)) {
        walk_.show_open(t, group);
        walk_.time = t;
        walk_.culprit = group;
        return walk_.shown;
      }
      walk_.is_open = false;
      continue;
    }
    const Crossing crossing = step_towards(walk_, t);
    if (crossing == Crossing::at_singularity) return walk_.shown;
    if (crossing == Crossing::limit) {
      walk_.is_open = true;
      walk_.culprit = walk_.events.back().group;
      gap_ = leave_branch(walk_);
    }
  }
  return walk_.here;
}

std::optional<MotionEvent> Follower::advance_to_limit(double t) {
  if (!walk_.started) walk_.start();
  walk_.stops_at_infinity = true;
  return walk_.is_open ? std::nullopt : walk_to_limit(walk_, t);
}

}  // namespace oblique::mechanism
