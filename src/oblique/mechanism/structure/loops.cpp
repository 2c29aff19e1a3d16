// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/loops.h>

#include <algorithm>
#include <cmath>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

constexpr double kEqual = 1e-9;  ///< of the longest link

bool in_group(const Group& group, std::size_t body) {
  return std::find(group.bodies.begin(), group.bodies.end(), body) != group.bodies.end();
}

/// The links outside of a group that carry a point.
std::vector<std::size_t> carriers(const Mechanism& mechanism, const Group& group, std::size_t point) {
  std::vector<std::size_t> found;
  for (const std::size_t body : mechanism.bodies_at(point)) {
    if (!in_group(group, body)) found.push_back(body);
  }
  return found;
}

/// A fixed point that a link is pinned to.
std::optional<std::size_t> pivot(const Mechanism& mechanism, std::size_t body) {
  for (const BodyPoint& p : mechanism.bodies[body].points) {
    if (mechanism.points[p.point].fixed) return p.point;
  }
  return std::nullopt;
}

struct Chain {
  LoopLink base, input;  ///< the base goes from the far revolute joint to the input's foot
};

/// Two links pinned to each other that carry `moving` and `far`; a loop with the frame is preferred.
std::optional<Chain> chain(const Mechanism& mechanism, const Group& group, std::size_t moving,
                           std::size_t far) {
  const auto link = [&](std::size_t body, std::size_t from, std::size_t to) {
    return LoopLink{body, from, to, distance(mechanism.bodies[body], from, to)};
  };
  for (const std::size_t x : carriers(mechanism, group, moving)) {
    if (mechanism.points[far].fixed) {
      const auto foot = pivot(mechanism, x);
      if (!foot || *foot == far) continue;
      const double ground = (mechanism.points[*foot].position - mechanism.points[far].position).norm();
      return Chain{{std::nullopt, far, *foot, ground}, link(x, *foot, moving)};
    }
    for (const std::size_t y : carriers(mechanism, group, far)) {
      if (y == x) continue;
      for (const BodyPoint& p : mechanism.bodies[x].points) {
        if (p.point == moving || p.point == far || mechanism.bodies[y].find(p.point) == nullptr) continue;
        return Chain{link(y, far, p.point), link(x, p.point, moving)};
      }
    }
  }
  return std::nullopt;
}

std::optional<FourBarLoop> four_bar(const Mechanism& mechanism, const Structure& structure, std::size_t g) {
  const auto& dyad = structure.groups[g].form.dyad;
  if (!dyad) return std::nullopt;
  LoopLink coupler{dyad->body1, dyad->p, dyad->c, dyad->r1}, output{dyad->body2, dyad->c, dyad->q, dyad->r2};
  if (mechanism.points[dyad->p].fixed) {
    coupler = {dyad->body2, dyad->q, dyad->c, dyad->r2};
    output = {dyad->body1, dyad->c, dyad->p, dyad->r1};
  }
  const auto rest = chain(mechanism, structure.groups[g], coupler.from, output.to);
  if (!rest) return std::nullopt;
  FourBarLoop loop;
  loop.group = g;
  loop.links = {rest->base, rest->input, coupler, output};
  std::array<double, 4> lengths{};
  std::transform(loop.links.begin(), loop.links.end(), lengths.begin(),
                 [](const LoopLink& link) { return link.length; });
  loop.type = grashof_class(lengths);
  if (rest->base.body) {
    const bool grashof = loop.type != GrashofClass::change_point && loop.type != GrashofClass::triple_rocker;
    if (grashof) loop.type = GrashofClass::grashof;
  }
  const auto [least, greatest] = std::minmax_element(lengths.begin(), lengths.end());
  loop.shortest_and_longest = *least + *greatest;
  loop.others = lengths[0] + lengths[1] + lengths[2] + lengths[3] - loop.shortest_and_longest;
  for (std::size_t i = 0; i < 4; ++i) {
    if (lengths[i] - *least <= kEqual * *greatest) loop.shortest.push_back(i);
  }
  return loop;
}

/// A crank that carries a point: the link and its fixed pivot.
std::optional<std::pair<std::size_t, std::size_t>> crank_at(const Mechanism& mechanism, const Group& group,
                                                            std::size_t point) {
  if (mechanism.points[point].fixed) return std::nullopt;
  for (const std::size_t body : carriers(mechanism, group, point)) {
    if (const auto foot = pivot(mechanism, body)) return std::pair{body, *foot};
  }
  return std::nullopt;
}

SliderLoop::Type slider_crank_type(double r, double l, double e) {
  const double same = kEqual * std::max({r, l, e});
  if (std::abs(l - r - e) <= same || std::abs(r - l - e) <= same) return SliderLoop::Type::change_point;
  if (l > r + e) return SliderLoop::Type::crank_turns;
  return r > l + e ? SliderLoop::Type::rod_turns : SliderLoop::Type::none_turns;
}

SliderLoop::Type lever_type(double r, double d, double e) {
  const double same = kEqual * std::max({r, d, e});
  if (std::abs(std::abs(r - d) - e) <= same) return SliderLoop::Type::change_point;
  if (std::abs(r - d) < e) return SliderLoop::Type::none_turns;
  return r > d ? SliderLoop::Type::lever_turns : SliderLoop::Type::lever_swings;
}

std::optional<SliderLoop> slider_crank(const Mechanism& mechanism, const Structure& structure,
                                       std::size_t g) {
  const Group& group = structure.groups[g];
  const auto& conditions = group.equations.conditions;
  const Condition& line = conditions[group.form.loci.back()];
  if (line.line.kind != LineRef::Kind::fixed) return std::nullopt;
  SliderLoop loop;
  loop.group = g;
  std::size_t pin = 0;
  if (group.form.revolute) {
    const Condition& revolute = conditions[*group.form.revolute];
    pin = revolute.b.point;
    loop.rod = group.equations.platforms[revolute.a.member];
    loop.length = (line.a.local - revolute.a.local).norm();
  } else {
    const Condition& rod = conditions[group.form.loci.front()];
    pin = rod.b.point;
    loop.rod = group.equations.binary_links[rod.link].body;
    loop.length = rod.value;
  }
  const auto crank = crank_at(mechanism, group, pin);
  if (!crank) return std::nullopt;
  loop.crank = crank->first;
  loop.radius = distance(mechanism.bodies[crank->first], crank->second, pin);
  loop.offset =
      std::abs(cross(line.line.direction, mechanism.points[crank->second].position - line.line.point));
  loop.type = slider_crank_type(loop.radius, loop.length, loop.offset);
  return loop;
}

std::optional<SliderLoop> slotted_lever(const Mechanism& mechanism, const Structure& structure,
                                        std::size_t g) {
  const Group& group = structure.groups[g];
  if (group.form.placing != Placing::about_pivot) return std::nullopt;
  const Condition& line = group.equations.conditions[group.form.loci.front()];
  const Condition& revolute = group.equations.conditions[*group.form.revolute];
  SliderLoop loop;
  loop.group = g;
  loop.is_lever = true;
  loop.rod = group.equations.platforms[revolute.a.member];
  loop.offset = std::abs(cross(line.line.direction, revolute.a.local - line.line.point));
  std::size_t pin = line.a.point, fixed = revolute.b.point;
  if (mechanism.points[pin].fixed) std::swap(pin, fixed);
  const auto crank = crank_at(mechanism, group, pin);
  if (!crank || !mechanism.points[fixed].fixed) return std::nullopt;
  loop.crank = crank->first;
  loop.radius = distance(mechanism.bodies[crank->first], crank->second, pin);
  loop.length = (mechanism.points[fixed].position - mechanism.points[crank->second].position).norm();
  loop.type = lever_type(loop.radius, loop.length, loop.offset);
  return loop;
}

}  // namespace

std::string_view grashof_name(GrashofClass type) {
  constexpr std::array<std::string_view, 6> kNames{"crank-rocker", "double crank",  "double rocker",
                                                   "change point", "triple rocker", "Grashof"};
  return kNames[static_cast<std::size_t>(type)];
}

std::string_view slider_loop_name(SliderLoop::Type type) {
  constexpr std::array<std::string_view, 6> kNames{"the crank turns fully",
                                                   "the rod turns fully, the crank swings",
                                                   "crank and lever turn fully",
                                                   "the crank turns fully, the lever swings",
                                                   "change point: they just pass each other",
                                                   "no link turns fully"};
  return kNames[static_cast<std::size_t>(type)];
}

GrashofClass grashof_class(const std::array<double, 4>& lengths) {
  const auto [least, greatest] = std::minmax_element(lengths.begin(), lengths.end());
  const double extremes = *least + *greatest;
  const double excess = lengths[0] + lengths[1] + lengths[2] + lengths[3] - 2 * extremes;
  if (std::abs(excess) <= kEqual * *greatest) return GrashofClass::change_point;
  if (excess < 0) return GrashofClass::triple_rocker;
  constexpr std::array kByShortest{GrashofClass::double_crank, GrashofClass::crank_rocker,
                                   GrashofClass::double_rocker, GrashofClass::crank_rocker};
  return kByShortest[static_cast<std::size_t>(least - lengths.begin())];
}

std::vector<FourBarLoop> four_bar_loops(const Mechanism& mechanism, const Structure& structure) {
  std::vector<FourBarLoop> loops;
  for (std::size_t g = 0; g < structure.groups.size(); ++g) {
    if (auto loop = four_bar(mechanism, structure, g)) loops.push_back(std::move(*loop));
  }
  return loops;
}

std::vector<SliderLoop> slider_loops(const Mechanism& mechanism, const Structure& structure) {
  std::vector<SliderLoop> loops;
  for (std::size_t g = 0; const Group& group : structure.groups) {
    const GroupKind kind = group.form.kind;
    if (kind == GroupKind::rrp) {
      if (auto loop = slider_crank(mechanism, structure, g)) loops.push_back(*loop);
    } else if (kind == GroupKind::rpr) {
      if (auto loop = slotted_lever(mechanism, structure, g)) loops.push_back(*loop);
    }
    ++g;
  }
  return loops;
}

}  // namespace oblique::mechanism
