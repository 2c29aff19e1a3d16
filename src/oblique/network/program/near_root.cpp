// SPDX-License-Identifier: MIT
#include <oblique/network/program/near_root.h>

#include <array>
#include <cmath>

namespace oblique::network {
namespace {

/// A loop of one unknown there.
struct Point {
  double residual, slope;
};

Point point_at(const LoopCode& loop, double* slots, double z, const std::function<void()>& evaluate) {
  slots[loop.unknown_slots[0]] = z;
  evaluate();
  Point point{slots[loop.residual_slots[0]], 0};
  for (const MatrixEntry& entry : loop.jacobian) point.slope += slots[entry.slot];
  return point;
}

}  // namespace

bool find_near_root(const LoopCode& loop, double* slots, double origin,
                    const std::function<void()>& evaluate) {
  constexpr double kFirstReach = 1e-16;  // of 1 + |origin|
  constexpr int kReaches = 50;           // each twice the one before: to a tenth
  constexpr double kContinuous = 1e-6;   // of the residual at the origin: what may be left of it at a root
  constexpr int kMostHalvings = 1100;    // from the largest number to the smallest
  if (loop.size() != 1) return false;
  const Point here = point_at(loop, slots, origin, evaluate);
  if (!std::isfinite(here.residual)) return false;
  // A root, a fold, or the edge of where there are values, lies between.
  const auto is_beyond = [&](double z) {
    const Point there = point_at(loop, slots, z, evaluate);
    return !(there.residual * here.residual > 0 && there.slope * here.slope > 0);
  };

  struct Side {
    double way, inner;
    bool open = true;
  };
  std::array<Side, 2> sides{Side{-1, origin}, Side{1, origin}};
  const double size = 1 + std::abs(origin);
  for (int doubled = 0; doubled < kReaches; ++doubled) {
    const double reach = std::ldexp(kFirstReach * size, doubled);
    for (Side& side : sides) {
      if (!side.open) continue;
      double outer = origin + side.way * reach;
      side.open = !is_beyond(outer);
      if (side.open) {
        side.inner = outer;
        continue;
      }
      for (int k = 0; k < kMostHalvings; ++k) {
        const double middle = side.inner + (outer - side.inner) / 2;
        if (middle == side.inner || middle == outer) break;
        (is_beyond(middle) ? outer : side.inner) = middle;
      }
      const double there = point_at(loop, slots, outer, evaluate).residual;
      if (there * here.residual <= 0 && std::abs(there) <= kContinuous * std::abs(here.residual)) return true;
    }
  }
  return false;
}

}  // namespace oblique::network
