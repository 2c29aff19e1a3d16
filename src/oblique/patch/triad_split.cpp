// SPDX-License-Identifier: MIT
#include <oblique/patch/triad_split.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/mechanism/plane.h>
#include <oblique/mechanism/triangle.h>

namespace oblique {
namespace {

using Eigen::Vector2d;

Vector2d apex(const Vector2d& from, const Vector2d& to, double first, double second, int side) {
  const Vector2d d = to - from;
  const double base = d.norm();
  const Triangle shape = triangle(base, first, second);
  return from + shape.along / base * d + side * shape.height / base * left_normal(d);
}

/// Sine of the angle at the apex of a triangle, with its side of first → second.
double apex_sine(const Vector2d& first, const Vector2d& apex, const Vector2d& second) {
  const Vector2d a = first - apex, b = second - apex;
  return cross(a, b) / (a.norm() * b.norm());
}

/// Measures one split along the motion; nothing where a sign changes.
std::optional<TriadSplit> measure(const Group& group, const Motion& motion,
                                  std::array<std::size_t, 3> order) {
  const auto& conditions = group.equations.conditions;
  const Condition &tracked = conditions[order[0]], &closing = conditions[order[1]],
                  &third = conditions[order[2]];
  const Vector2d bone = third.a.local - tracked.a.local;
  const double platform = bone.norm();
  if (!(platform > 0)) return std::nullopt;
  const Vector2d arm = closing.a.local - tracked.a.local;
  // C − B = (a + i b)(D − B)
  const double a = bone.dot(arm) / bone.squaredNorm(), b = cross(bone, arm) / bone.squaredNorm();

  TriadSplit split;
  split.tracked = order[0];
  split.closing = order[1];
  split.third = order[2];
  split.flattest = split.least_gain = std::numeric_limits<double>::infinity();
  double least_slope = split.least_gain;
  for (const Configuration& here : motion.configurations) {
    const auto at = [&](const PointRef& point) { return here.points[point.point].position; };
    const Vector2d start = at(tracked.b), anchor = at(closing.b), end = at(third.b);
    const Vector2d apex1 = at(tracked.a), apex2 = at(third.a);
    const double w = (apex1 - anchor).norm();
    const double sine1 = apex_sine(start, apex1, anchor), sine2 = apex_sine(apex1, apex2, end);
    const int side1 = sine1 > 0 ? 1 : -1, side2 = sine2 > 0 ? 1 : -1;
    const auto closed = [&](double length) {
      const Vector2d first = apex(start, anchor, tracked.value, length, side1);
      const Vector2d second = apex(first, end, platform, third.value, side2);
      const Vector2d way = second - first;
      const Vector2d c = first + a * way + b * left_normal(way);
      return (c - anchor).squaredNorm() / (closing.value * closing.value);
    };
    const double step = 1e-5 * w;
    const double slope = (closed(w + step) - closed(w - step)) / (2 * step);
    const int sign = slope > 0 ? 1 : -1;
    if (split.sign == 0) {
      split.first_side = side1;
      split.second_side = side2;
      split.sign = sign;
      split.first_w = w;
    }
    if (side1 != split.first_side || side2 != split.second_side || sign != split.sign) return std::nullopt;
    split.flattest = std::min({split.flattest, std::abs(sine1), std::abs(sine2)});
    split.longest = std::max(split.longest, w);
    split.reach = std::max({split.reach, w, (anchor - start).norm()});
    least_slope = std::min(least_slope, std::abs(slope));
  }
  split.least_gain = least_slope * split.reach;
  return split;
}

}  // namespace

std::optional<TriadSplit> choose_split(const Group& group, const Motion& motion) {
  const auto& conditions = group.equations.conditions;
  if (group.kind != GroupKind::triad ||
      std::any_of(conditions.begin(), conditions.end(),
                  [](const Condition& c) { return c.kind != Condition::Kind::distance; })) {
    return std::nullopt;
  }
  // below this a triangle is as good as flat, or a loop without gain, at some position
  constexpr double kLeast = 0.02;
  std::optional<TriadSplit> best;
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    const auto split = measure(group, motion, order);
    if (!split) continue;
    const double worth = std::min(split->flattest, split->least_gain);
    if (worth > kLeast && (!best || worth > std::min(best->flattest, best->least_gain))) best = split;
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

}  // namespace oblique
