// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/group_form.h>

#include <algorithm>
#include <stdexcept>

namespace oblique::mechanism {
namespace {

/// Whether one end of a condition is given by the groups before.
bool has_known_end(const Condition& c) {
  const bool is_line_known = c.line.kind != LineRef::Kind::carried;
  switch (c.kind) {
    case Condition::Kind::orientation:
      return is_line_known;
    case Condition::Kind::on_line:
    case Condition::Kind::along:
      return (c.a.kind == PointRef::Kind::known) != is_line_known;
    case Condition::Kind::distance:
    case Condition::Kind::coincidence:
      return c.b.kind == PointRef::Kind::known;
  }
  throw std::logic_error("a condition of no kind");
}

/// The conditions of a group of one unknown point or link by what they do.
struct Sorted {
  std::vector<std::size_t> revolutes, angles, circles, lines, ways;  ///< ways: a drive's, along a line
  bool has_own_line = false;  ///< of the lines that are no drive's: one is the unknown link's
};

/// Nothing where there are more unknowns, or conditions between them.
std::optional<Sorted> sorted(const GroupEquations& equations) {
  constexpr std::size_t kOfABody = 3;
  if (equations.unknowns() > kOfABody) return std::nullopt;
  Sorted by;
  for (std::size_t i = 0; i < equations.conditions.size(); ++i) {
    const Condition& c = equations.conditions[i];
    if (!has_known_end(c)) return std::nullopt;
    switch (c.kind) {
      case Condition::Kind::distance:
        by.circles.push_back(i);
        break;
      case Condition::Kind::coincidence:
        by.revolutes.push_back(i);
        break;
      case Condition::Kind::on_line:
        by.lines.push_back(i);
        by.has_own_line = by.has_own_line || c.line.kind == LineRef::Kind::carried;
        break;
      case Condition::Kind::along:
        by.ways.push_back(i);
        break;
      case Condition::Kind::orientation:
        by.angles.push_back(i);
        break;
    }
  }
  return by;
}

/// Of a link pinned to a known point, whose direction is not given.
GroupKind kind_about_pivot(const Sorted& by) {
  if (!by.ways.empty()) return GroupKind::general;
  if (!by.circles.empty()) return GroupKind::rrr;
  return by.has_own_line ? GroupKind::rpr : GroupKind::rrp;
}

/// Of a point, or a link whose direction is given, where two loci meet.
GroupKind kind_of_crossing(const Sorted& by, bool is_turned) {
  if (is_turned) return GroupKind::general;
  if (!by.ways.empty()) {
    const bool is_led = by.lines.size() == 1 && !by.has_own_line;
    return is_led ? GroupKind::slider : GroupKind::general;
  }
  if (by.circles.size() == 2) return GroupKind::rrr;
  if (by.circles.size() == 1) return by.has_own_line ? GroupKind::rpr : GroupKind::rrp;
  return by.has_own_line ? GroupKind::rpp : GroupKind::prp;
}

Dyad dyad_on(const GroupEquations& equations) {
  const Condition* first = &equations.conditions[0];
  const Condition* second = &equations.conditions[1];
  const auto body = [&](const Condition& c) { return equations.binary_links[c.link].body; };
  if (body(*second) < body(*first)) std::swap(first, second);
  return {body(*first),   first->b.point, body(*second), second->b.point,
          first->a.point, first->value,   second->value};
}

}  // namespace

std::string_view kind_name(GroupKind kind) {
  switch (kind) {
    case GroupKind::crank:
      return "crank";
    case GroupKind::slider:
      return "slider";
    case GroupKind::rrr:
      return "RRR";
    case GroupKind::rrp:
      return "RRP";
    case GroupKind::prp:
      return "PRP";
    case GroupKind::rpr:
      return "RPR";
    case GroupKind::rpp:
      return "RPP";
    case GroupKind::triad:
      return "triad";
    case GroupKind::general:
      return "general";
  }
  throw std::logic_error("a group of no kind");
}

GroupForm form_of(const GroupEquations& equations) {
  GroupForm form;
  const std::optional<Sorted> by = sorted(equations);
  if (!by) return form;
  form.circles = by->circles.size();
  if (!by->revolutes.empty()) form.revolute = by->revolutes.front();
  if (!by->angles.empty()) form.angle = by->angles.front();
  const bool is_body = !equations.platforms.empty();
  const bool is_turned = form.angle && equations.conditions[*form.angle].drive.has_value();
  for (const auto* loci : {&by->circles, &by->lines, &by->ways})
    form.loci.insert(form.loci.end(), loci->begin(), loci->end());
  if (form.revolute && form.angle) {
    form.placing = is_turned ? Placing::rotation : Placing::pinned;
    form.kind = is_turned ? GroupKind::crank : GroupKind::general;
  } else if (form.revolute) {
    form.placing = Placing::about_pivot;
    form.kind = kind_about_pivot(*by);
  } else if (is_body && by->angles.empty()) {
    if (!by->ways.empty()) return form;
    form.placing = Placing::platform;
    form.kind = GroupKind::triad;
  } else if (by->angles.size() > 1) {
    return form;
  } else if (!is_body && form.circles == 2) {
    form.placing = Placing::triangle;
    form.kind = GroupKind::rrr;
    form.dyad = dyad_on(equations);
  } else {
    form.placing = Placing::crossing;
    form.kind = kind_of_crossing(*by, is_turned);
  }
  return form;
}

}  // namespace oblique::mechanism
