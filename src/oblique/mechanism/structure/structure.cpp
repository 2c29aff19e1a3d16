// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/structure.h>

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/mechanism/solver/assembly.h>
#include <oblique/mechanism/structure/assur_class.h>
#include <oblique/mechanism/structure/constraint_graph.h>
#include <oblique/mechanism/structure/mobility_report.h>
#include <oblique/mechanism/structure/redundancy.h>

namespace oblique::mechanism {
namespace {

void add_once(std::vector<std::size_t>& list, std::size_t item) {
  if (!has(list, item)) list.push_back(item);
}

/// A group while it is put together.
struct Part {
  GroupMembers members;
  std::vector<std::size_t> needs;    ///< parts that come before
  std::vector<std::size_t> carried;  ///< points that its links carry along
};

/// Takes a mechanism apart and orders the groups:
///
/// 1. `ConstraintGraph` matches each condition with an unknown that it determines. An edge then leads from
/// the
///    vertex that owns a condition to what the condition needs, and the strongly connected components are
///    the parts that only together have a place.
/// 2. A component that is nothing but a point of one link goes to the part of that link, which carries it.
/// 3. Of the parts that have all they need, the next is always the one whose drive stands first in the file,
///    then whose first link does. So the order does not depend on the matching, of which there are many, and
///    files that say the same give the same rows and names.
/// 4. In that order each part is reduced to equations, whose form then is known: what earlier groups place
///    counts as given.
class Decomposition {
 public:
  explicit Decomposition(const Mechanism& mechanism)
      : mechanism_(mechanism), graph_(mechanism), known_(mechanism.points.size()) {
    for (std::size_t i = 0; i < mechanism.points.size(); ++i) known_[i] = mechanism.points[i].fixed;
  }

  Structure run() {
    check_parts(mechanism_, graph_);
    collect();
    std::vector<bool> done(parts_.size());
    for (std::size_t count = 0; count < parts_.size(); ++count) {
      const std::size_t next = first_ready(done);
      done[next] = true;
      add(parts_[next]);
    }
    return std::move(structure_);
  }

 private:
  void collect() {
    std::vector<std::size_t> part_of(mechanism_.bodies.size() + mechanism_.points.size());
    for (const auto& component : graph_.components()) {
      Part part;
      std::vector<std::size_t> needs;
      for (const std::size_t v : component) {
        if (graph_.is_body(v)) {
          part.members.bodies.push_back(v);
        } else {
          part.members.points.push_back(graph_.point_of(v));
        }
        for (const std::size_t owned : graph_.owned(v)) {
          const ConstraintGraph::Edge& edge = graph_.edges()[owned];
          if (edge.kind == ConstraintGraph::Edge::Kind::turn ||
              edge.kind == ConstraintGraph::Edge::Kind::along) {
            add_once(part.members.drives, edge.index);
          } else if (edge.kind != ConstraintGraph::Edge::Kind::revolute) {
            add_once(part.members.slides, edge.index);
          }
          const std::size_t other = edge.a == v ? edge.b : edge.a;
          if (other != ConstraintGraph::kFrame && !is_fixed(other) && !has(component, other)) {
            add_once(needs, part_of[other]);
          }
        }
      }
      // a point that hangs on one link alone is that link's
      if (part.members.bodies.empty() && part.members.slides.empty()) {
        const std::size_t owner = needs.front();
        for (const std::size_t v : component) {
          part_of[v] = owner;
          parts_[owner].carried.push_back(graph_.point_of(v));
        }
        continue;
      }
      std::sort(part.members.slides.begin(), part.members.slides.end());
      part.needs = std::move(needs);
      for (const std::size_t v : component) part_of[v] = parts_.size();
      parts_.push_back(std::move(part));
    }
  }

  bool is_fixed(std::size_t vertex) const {
    return !graph_.is_body(vertex) && mechanism_.points[graph_.point_of(vertex)].fixed;
  }

  /// Of the parts that have all they need, the driven ones first, then by their first link.
  std::size_t first_ready(const std::vector<bool>& done) const {
    constexpr std::size_t kLast = std::numeric_limits<std::size_t>::max();
    std::size_t best = kLast;
    std::array<std::size_t, 3> best_key{kLast, kLast, kLast};
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part& part = parts_[i];
      const bool ready =
          std::all_of(part.needs.begin(), part.needs.end(), [&](std::size_t n) { return done[n]; });
      if (done[i] || !ready) continue;
      const std::array<std::size_t, 3> key{part.members.drives.empty() ? kLast : part.members.drives.front(),
                                           part.members.bodies.empty() ? kLast : part.members.bodies.front(),
                                           i};
      if (best != kLast && key >= best_key) continue;
      best = i;
      best_key = key;
    }
    return best;
  }

  void add(const Part& part) {
    Group group;
    group.bodies = part.members.bodies;
    group.slides = part.members.slides;
    group.drives = part.members.drives;
    std::vector<std::string> names;
    for (const std::size_t body : group.bodies) names.push_back(mechanism_.bodies[body].name);
    if (names.empty()) {
      for (const std::size_t slide : group.slides) names.push_back(mechanism_.slides[slide].name);
    }
    group.name = fmt::format("{}", fmt::join(names, "-"));
    group.equations = reduce(mechanism_, part.members, known_);
    group.form = form_of(group.equations);
    group.order = order_of(mechanism_, part.members, known_);
    group.assur_class = group.form.kind == GroupKind::crank || group.form.kind == GroupKind::slider
                            ? 1
                            : class_of(mechanism_, part.members, known_);
    group.points = part.members.points;
    group.points.insert(group.points.end(), part.carried.begin(), part.carried.end());
    std::sort(group.points.begin(), group.points.end());
    for (const std::size_t point : group.points) known_[point] = true;
    structure_.groups.push_back(std::move(group));
  }

  const Mechanism& mechanism_;
  ConstraintGraph graph_;
  std::vector<bool> known_;
  std::vector<Part> parts_;
  Structure structure_;
};

}  // namespace

std::size_t pivot_of(const Group& crank) {
  return crank.equations.conditions[crank.form.revolute.value()].b.point;
}

int mobility(const Mechanism& mechanism) {
  int conditions = 0;
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    const int sharing = static_cast<int>(mechanism.bodies_at(i).size()) + (mechanism.points[i].fixed ? 1 : 0);
    conditions += 2 * std::max(0, sharing - 1);
  }
  for (const Slide& slide : mechanism.slides) conditions += slide.of ? 2 : 1;
  return 3 * static_cast<int>(mechanism.bodies.size()) - conditions;
}

Structure find_groups(const Mechanism& mechanism) {
  check_mobility(mechanism);
  return Decomposition(mechanism).run();
}

Structure decompose(const Mechanism& mechanism) {
  Structure structure;
  try {
    structure = find_groups(mechanism);
  } catch (const MechanismError& error) {
    auto findings = error.diagnostics();
    for (text::Diagnostic& finding : redundancy_findings(mechanism)) findings.push_back(std::move(finding));
    throw MechanismError(error.kind(), std::move(findings));
  }
  choose_modes(mechanism, structure);
  return structure;
}

}  // namespace oblique::mechanism
