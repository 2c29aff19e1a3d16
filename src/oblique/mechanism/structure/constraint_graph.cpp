// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/constraint_graph.h>

#include <algorithm>

namespace oblique::mechanism {

ConstraintGraph::ConstraintGraph(const Mechanism& mechanism) : bodies_(mechanism.bodies.size()) {
  capacity_.assign(bodies_, 3);
  for (const Point& point : mechanism.points) capacity_.push_back(point.fixed ? 0 : 2);
  owned_.resize(capacity_.size());
  incident_.resize(capacity_.size());
  using Kind = Edge::Kind;
  const auto carrier = [](const Slide& slide) { return slide.carrier.value_or(kFrame); };
  // a link that may not turn is guided itself, not its point
  const auto guided = [&](const Slide& slide) { return slide.of ? *slide.of : point_vertex(slide.point); };
  // drives first: what is too much then is a pair
  for (std::size_t d = 0; d < mechanism.drives.size(); ++d) {
    const Drive& drive = mechanism.drives[d];
    if (drive.slide) {
      const Slide& slide = mechanism.slides[*drive.slide];
      add({Kind::along, d, 0, guided(slide), carrier(slide)});
    } else {
      add({Kind::turn, d, 0, drive.body});
    }
  }
  for (std::size_t body = 0; body < bodies_; ++body) {
    for (const BodyPoint& p : mechanism.bodies[body].points) {
      for (int coordinate = 0; coordinate < 2; ++coordinate) {
        add({Kind::revolute, body, p.point, body, point_vertex(p.point)});
      }
    }
  }
  for (std::size_t s = 0; s < mechanism.slides.size(); ++s) {
    const Slide& slide = mechanism.slides[s];
    add({Kind::on_line, s, 0, guided(slide), carrier(slide)});
    if (slide.of) add({Kind::angle, s, 0, guided(slide), carrier(slide)});
  }
}

void ConstraintGraph::add(Edge edge) {
  const std::size_t index = edges_.size();
  edges_.push_back(edge);
  for (const std::size_t end : {edge.a, edge.b}) {
    if (exists(end)) incident_[end].push_back(index);
  }
  for (const std::size_t end : {edge.b, edge.a}) {  // points before links
    std::vector<bool> seen(capacity_.size());
    if (!exists(end) || !find_unknown(end, seen)) continue;
    edges_[index].owner = end;
    owned_[end].push_back(index);
    return;
  }
  redundant_.push_back(index);
}

/// Frees an unknown of the vertex, if need be by giving one of its conditions to its other end.
bool ConstraintGraph::find_unknown(std::size_t vertex, std::vector<bool>& seen) {
  seen[vertex] = true;
  if (owned_[vertex].size() < static_cast<std::size_t>(capacity_[vertex])) return true;
  for (const std::size_t index : owned_[vertex]) {
    Edge& edge = edges_[index];
    const std::size_t other = edge.a == vertex ? edge.b : edge.a;
    if (!exists(other) || seen[other] || !find_unknown(other, seen)) continue;
    auto& list = owned_[vertex];
    list.erase(std::find(list.begin(), list.end(), index));
    edge.owner = other;
    owned_[other].push_back(index);
    return true;
  }
  return false;
}

std::vector<std::size_t> ConstraintGraph::competitors(std::size_t edge) const {
  std::vector<bool> seen(capacity_.size());
  std::vector<std::size_t> found;
  const auto visit = [&](std::size_t vertex) {
    if (!exists(vertex) || seen[vertex]) return;
    seen[vertex] = true;
    found.push_back(vertex);
  };
  visit(edges_[edge].a);
  visit(edges_[edge].b);
  for (std::size_t next = 0; next < found.size(); ++next) {
    for (const std::size_t owned : owned_[found[next]]) {
      visit(edges_[owned].a);
      visit(edges_[owned].b);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

int ConstraintGraph::freedom() const {
  int free = 0;
  for (std::size_t v = 0; v < capacity_.size(); ++v)
    free += capacity_[v] - static_cast<int>(owned_[v].size());
  return free;
}

std::vector<std::size_t> ConstraintGraph::movable() const {
  std::vector<bool> seen(capacity_.size());
  std::vector<std::size_t> found;
  for (std::size_t v = 0; v < capacity_.size(); ++v) {
    if (owned_[v].size() >= static_cast<std::size_t>(capacity_[v])) continue;
    seen[v] = true;
    found.push_back(v);
  }
  // who depends on a vertex that moves, moves
  for (std::size_t next = 0; next < found.size(); ++next) {
    for (const std::size_t index : incident_[found[next]]) {
      const std::size_t owner = edges_[index].owner;
      if (owner == kFrame || seen[owner]) continue;
      seen[owner] = true;
      found.push_back(owner);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::vector<std::size_t>> ConstraintGraph::components() const {
  // R. Tarjan's algorithm, whose components come out in the order of dependence. Depth: the number of
  // vertices.
  constexpr int kUnseen = -1;
  std::vector<int> order(capacity_.size(), kUnseen), lowest(capacity_.size(), 0);
  std::vector<bool> open(capacity_.size());
  std::vector<std::size_t> stack;
  std::vector<std::vector<std::size_t>> components;
  int counter = 0;
  const auto visit = [&](const auto& self, std::size_t v) -> void {
    order[v] = lowest[v] = counter++;
    stack.push_back(v);
    open[v] = true;
    for (const std::size_t index : owned_[v]) {
      const Edge& edge = edges_[index];
      const std::size_t other = edge.a == v ? edge.b : edge.a;
      if (!exists(other)) continue;
      if (order[other] == kUnseen) {
        self(self, other);
        lowest[v] = std::min(lowest[v], lowest[other]);
      } else if (open[other]) {
        lowest[v] = std::min(lowest[v], order[other]);
      }
    }
    if (lowest[v] != order[v]) return;
    std::vector<std::size_t> component;
    do {
      component.push_back(stack.back());
      open[stack.back()] = false;
      stack.pop_back();
    } while (component.back() != v);
    std::sort(component.begin(), component.end());
    components.push_back(std::move(component));
  };
  for (std::size_t v = 0; v < capacity_.size(); ++v) {
    if (exists(v) && order[v] == kUnseen) visit(visit, v);
  }
  return components;
}

}  // namespace oblique::mechanism
