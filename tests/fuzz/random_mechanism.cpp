// SPDX-License-Identifier: MIT
#include "random_mechanism.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace oblique::fuzz {
namespace {

using Place = MechanismPlan::Place;

Place random_place(Dice& dice) {
  const double x = dice.number(-1.5, 1.5);
  return {x, dice.number(-1.5, 1.5)};
}

}  // namespace

MechanismPlan plan_mechanism(Dice& dice) {
  MechanismPlan plan;
  const std::size_t kind = dice.below(4);
  const Place crank{dice.number(0.0625, 0.3125), 0};
  const auto place = [&] { return random_place(dice); };
  switch (kind) {
    case 0:  // frame 0 1, crank to 2, coupler to 3
      plan.points = {{}, place(), crank, place()};
      plan.fixed = 2;
      plan.links = {{0, 2, {}}, {2, 3, {}}, {3, 1, {}}};
      break;
    case 1: {  // the line through 1 and 2 carries 4
      const double height = dice.number(-0.5, 0.5);
      plan.points = {{}, {0, height}, {1, height}, crank, {dice.number(0.5, 2), height}};
      plan.fixed = 3;
      plan.links = {{0, 3, {}}, {3, 4, {}}};
      plan.slide = MechanismPlan::Slide{4, 1, 2};
      break;
    }
    case 2:  // a four-bar 0 3 4 1 whose coupler moves a dyad 5 6 2
      plan.points = {{}, place(), place(), crank, place(), place(), place()};
      plan.fixed = 3;
      plan.links = {{0, 3, {}}, {3, 4, 5}, {4, 1, {}}, {5, 6, {}}, {6, 2, {}}};
      break;
    default:  // the platform 4 5 6 on three links
      plan.points = {{}, place(), place(), crank, place(), place(), place()};
      plan.fixed = 3;
      plan.links = {{0, 3, {}}, {3, 4, {}}, {4, 5, 6}, {5, 2, {}}, {1, 6, {}}};
  }
  return plan;
}

std::string point_name(std::size_t point, const MechanismWriting& writing) {
  return writing.other_names ? fmt::format("z{}", 90 - point) : fmt::format("P{}", point);
}

std::string text_of(const MechanismPlan& plan, const MechanismWriting& writing) {
  const auto name = [&](std::size_t point) { return point_name(point, writing); };
  const auto at = [&](std::size_t point) {
    return fmt::format("{} = [{}, {}]\n", name(point), plan.points[point].x * writing.scale,
                       plan.points[point].y * writing.scale);
  };
  std::string out = "format = \"oblique-mechanism/1\"\n[frame]\n";
  for (std::size_t p = 0; p < plan.fixed; ++p) out += at(p);
  const auto link_name = [&](std::size_t k) {
    return writing.other_names ? fmt::format("y{}", 90 - k) : fmt::format("L{}", k);
  };
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < plan.links.size(); ++k) {
    const MechanismPlan::Link& link = plan.links[k];
    const Place &a = plan.points[link.first], &b = plan.points[link.second];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    std::string line = fmt::format("{} = {{ points = [\"{}\", \"{}\"], length = {}", link_name(k),
                                   name(link.first), name(link.second), length * writing.scale);
    if (link.mark) {
      const double mx = plan.points[*link.mark].x - a.x, my = plan.points[*link.mark].y - a.y;
      line += fmt::format(", marks = {{ {} = [{}, {}] }}", name(*link.mark),
                          (dx * mx + dy * my) / length * writing.scale,
                          (dx * my - dy * mx) / length * writing.scale);
    }
    lines.push_back(line + " }\n");
  }
  if (writing.other_order) std::reverse(lines.begin(), lines.end());
  out += "[bodies]\n";
  for (const std::string& line : lines) out += line;
  if (plan.slide) {
    out += fmt::format("[slides]\ns = {{ point = \"{}\", along = [\"{}\", \"{}\"] }}\n",
                       name(plan.slide->point), name(plan.slide->from), name(plan.slide->to));
  }
  out += fmt::format("[drives]\ncrank = {{ turns = \"{}\", about = \"{}\", speed = 1 }}\n[sketch]\n",
                     link_name(0), name(0));
  const std::size_t crank = plan.links.front().second;
  for (std::size_t p = plan.fixed; p < plan.points.size(); ++p) {
    if (p != crank) out += at(p);
  }
  return out;
}

}  // namespace oblique::fuzz
