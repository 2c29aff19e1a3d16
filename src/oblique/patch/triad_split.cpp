// SPDX-License-Identifier: MIT
#include <oblique/patch/triad_split.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/mechanism/triad/triangle.h>
#include <oblique/patch/patch_error.h>
#include <oblique/patch/patch_setup.h>

namespace oblique::patch {
namespace {

using Eigen::Vector2d;

Vector2d apex(const Vector2d& from, const Vector2d& to, double first, double second, int side) {
  const Vector2d d = to - from;
  const double base = d.norm();
  const mechanism::Triangle shape = mechanism::triangle(base, first, second);
  return from + shape.along / base * d + side * shape.height / base * mechanism::left_normal(d);
}

/// Sine of the angle at the apex of a triangle, with its side of first → second.
double apex_sine(const Vector2d& first, const Vector2d& apex, const Vector2d& second) {
  const Vector2d a = first - apex, b = second - apex;
  return mechanism::cross(a, b) / (a.norm() * b.norm());
}

/// Measures one split along the motion.
TriadSplit measure(const mechanism::Group& group, const mechanism::Motion& motion,
                   std::array<std::size_t, 3> order) {
  const auto& conditions = group.equations.conditions;
  const mechanism::Condition &tracked = conditions[order[0]], &closing = conditions[order[1]],
                             &third = conditions[order[2]];
  const Vector2d bone = third.a.local - tracked.a.local;
  const double platform = bone.norm();
  const Vector2d arm = closing.a.local - tracked.a.local;
  // C − B = (a + i b)(D − B)
  const double a = bone.dot(arm) / bone.squaredNorm(), b = mechanism::cross(bone, arm) / bone.squaredNorm();

  TriadSplit split;
  split.tracked = order[0];
  split.closing = order[1];
  split.third = order[2];
  split.flattest = std::numeric_limits<double>::infinity();
  double least_derivative = split.flattest;
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const mechanism::Configuration& here = motion.configurations[row];
    const auto at = [&](const mechanism::PointRef& point) { return here.points[point.point].position; };
    const Vector2d start = at(tracked.b), anchor = at(closing.b), end = at(third.b);
    const Vector2d apex1 = at(tracked.a), apex2 = at(third.a);
    const double w = (apex1 - anchor).norm();
    const double sine1 = apex_sine(start, apex1, anchor), sine2 = apex_sine(apex1, apex2, end);
    const int side1 = sine1 > 0 ? 1 : -1, side2 = sine2 > 0 ? 1 : -1;
    const auto closed = [&](double length) {
      const Vector2d first = apex(start, anchor, tracked.value, length, side1);
      const Vector2d second = apex(first, end, platform, third.value, side2);
      const Vector2d way = second - first;
      const Vector2d c = first + a * way + b * mechanism::left_normal(way);
      return (c - anchor).squaredNorm() / (closing.value * closing.value);
    };
    const double step = 1e-5 * w;
    const double derivative = (closed(w + step) - closed(w - step)) / (2 * step);
    const int sign = derivative > 0 ? 1 : -1;
    if (row == 0) {
      split.first_side = side1;
      split.second_side = side2;
      split.sign = sign;
      split.first_w = w;
    }
    if (split.flip == TriadSplit::Flip::none) {
      split.flip = side1 != split.first_side    ? TriadSplit::Flip::first_triangle
                   : side2 != split.second_side ? TriadSplit::Flip::second_triangle
                   : sign != split.sign         ? TriadSplit::Flip::loop
                                                : TriadSplit::Flip::none;
      split.flip_time = motion.times[row];
    }
    split.flattest = std::min({split.flattest, std::abs(sine1), std::abs(sine2)});
    split.longest = std::max(split.longest, w);
    split.reach = std::max({split.reach, w, (anchor - start).norm()});
    split.second_reach = std::max(split.second_reach, (end - apex1).norm());
    least_derivative = std::min(least_derivative, std::abs(derivative));
  }
  split.least_gain = least_derivative * split.reach;
  return split;
}

std::vector<std::string> legs_of(const mechanism::Mechanism& mechanism, const mechanism::Group& triad,
                                 const TriadSplit& split) {
  std::vector<std::string> names;
  for (const std::size_t leg : {split.tracked, split.closing, split.third})
    names.push_back(mechanism.bodies[leg_of(triad, leg)].name);
  return names;
}

bool is_on_links(const mechanism::Group& group) {
  return group.form.is_triad_on_links();
}

std::string joined(const std::vector<std::string>& legs) {
  return fmt::format("{}", fmt::join(legs, ","));
}

}  // namespace

double TriadSplit::worth() const {
  return flip == Flip::none ? std::min(flattest, least_gain) : 0;
}

std::vector<TriadSplit> splits_of(const mechanism::Group& group, const mechanism::Motion& motion) {
  std::vector<TriadSplit> splits;
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    splits.push_back(measure(group, motion, order));
  } while (std::next_permutation(order.begin(), order.end()));
  std::stable_sort(splits.begin(), splits.end(),
                   [](const TriadSplit& a, const TriadSplit& b) { return a.worth() > b.worth(); });
  return splits;
}

std::size_t leg_of(const mechanism::Group& triad, std::size_t condition) {
  return triad.equations.binary_links[triad.equations.conditions[condition].link].body;
}

std::string split_name(const mechanism::Mechanism& mechanism, const mechanism::Group& triad,
                       const TriadSplit& split) {
  return fmt::format("{}", fmt::join(legs_of(mechanism, triad, split), ", "));
}

TriadSplit choose_split(const mechanism::Mechanism& mechanism, const mechanism::Group& triad,
                        const mechanism::Motion& motion, const PatchOptions& options) {
  std::vector<TriadSplit> splits = splits_of(triad, motion);
  const text::Place& place = mechanism.bodies[triad.equations.platforms.front()].place;
  const auto named = std::find_if(splits.begin(), splits.end(), [&](const TriadSplit& split) {
    return legs_of(mechanism, triad, split) == options.split;
  });
  if (named == splits.end()) {
    if (splits.front().worth() > kLeastWorth || options.force) return splits.front();
    throw PatchError(text::Diagnostic{place,
                                      fmt::format("the group {} ({}) has no split into two triangles that "
                                                  "never become collinear and a loop that "
                                                  "keeps its gain on the way",
                                                  triad.name, mechanism::kind_name(triad.form.kind)),
                                      "a triad on three links with such a split",
                                      text::Remedy{"patch it with ", text::Setting{"method", "gradient"},
                                                   ", which takes any group"}})
        .forcible();
  }
  if (named->flip != TriadSplit::Flip::none && !options.force) {
    throw PatchError(
        text::Diagnostic{
            place,
            fmt::format(
                "with the split {} of the triad {}, {} at t = {:.6g} s", split_name(mechanism, triad, *named),
                triad.name,
                named->flip == TriadSplit::Flip::loop
                    ? fmt::format("the loop that tracks the variable length changes the sign of its gain")
                    : fmt::format("the {} triangle becomes collinear and turns over",
                                  named->flip == TriadSplit::Flip::first_triangle ? "first" : "second"),
                named->flip_time),
            "triangles that never become collinear and a loop that keeps its sign",
            splits.front().worth() > kLeastWorth
                ? text::Remedy{text::Setting{"split", joined(legs_of(mechanism, triad, splits.front()))},
                               " never flips"}
                : text::Remedy{"patch it with ", text::Setting{"method", "gradient"},
                               ", which takes any group"}})
        .forcible();
  }
  named->asked_for = true;
  return *named;
}

void check_split_options(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                         const PatchOptions& options) {
  const bool splits = std::any_of(structure.groups.begin(), structure.groups.end(), is_on_links);
  if (options.slower && !splits) {
    throw PatchError(text::Diagnostic{{mechanism.file, {}, {"slower", fmt::format("{:g}", *options.slower)}},
                                      "this patch has no outer loop",
                                      "a mechanism with a triad on three links",
                                      "leave it out"},
                     PatchError::Kind::request);
  }
  if (options.split.empty()) return;
  std::vector<std::string> triads;
  for (const mechanism::Group& group : structure.groups) {
    if (!is_on_links(group)) continue;
    std::vector<std::string> legs = legs_of(mechanism, group, TriadSplit{});
    triads.push_back(joined(legs));
    if (std::is_permutation(legs.begin(), legs.end(), options.split.begin(), options.split.end())) return;
  }
  throw PatchError(
      text::Diagnostic{
          {mechanism.file, {}, {"split", joined(options.split)}},
          "no triad has these legs",
          triads.empty() ? "a triad on three links, which this mechanism does not have"
                         : fmt::format("the three legs of a triad in any order: {}", fmt::join(triads, "; ")),
          {}},
      PatchError::Kind::request);
}

std::vector<NamedSplit> all_splits(const mechanism::Mechanism& mechanism) {
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  const auto triad = std::find_if(structure.groups.begin(), structure.groups.end(), is_on_links);
  if (triad == structure.groups.end() || std::any_of(triad + 1, structure.groups.end(), is_on_links))
    return {};
  std::vector<NamedSplit> all;
  for (const TriadSplit& split : splits_of(*triad, patch_motion(mechanism, structure))) {
    std::vector<std::string> legs = legs_of(mechanism, *triad, split);
    all.push_back({std::move(legs), split});
  }
  return all;
}

std::vector<std::vector<std::string>> useful_splits(const mechanism::Mechanism& mechanism) {
  std::vector<std::vector<std::string>> names;
  for (NamedSplit& split : all_splits(mechanism)) {
    if (split.split.worth() > kLeastWorth) names.push_back(std::move(split.legs));
  }
  return names;
}

}  // namespace oblique::patch
