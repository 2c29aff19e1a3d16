// SPDX-License-Identifier: MIT
#include <oblique/network/graph/dependency_order.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace oblique::network {
namespace {

using Component = std::vector<std::uint32_t>;

constexpr std::uint32_t kUnvisited = std::numeric_limits<std::uint32_t>::max();

/// Tarjan's algorithm without recursion, on any subset of the quantities.
class ComponentFinder {
 public:
  explicit ComponentFinder(const Dependencies& graph)
      : graph_(&graph),
        scope_(graph.size(), 0),
        index_(graph.size(), kUnvisited),
        low_(graph.size(), 0),
        on_stack_(graph.size(), false) {}

  /// The strongly connected components among `members`, each after those it needs.
  std::vector<Component> find(const Component& members) {
    ++current_scope_;
    for (const std::uint32_t m : members) {
      scope_[m] = current_scope_;
      index_[m] = kUnvisited;
    }
    components_.clear();
    counter_ = 0;
    for (const std::uint32_t m : members) {
      if (index_[m] == kUnvisited) visit(m);
    }
    return std::move(components_);
  }

 private:
  struct Frame {
    std::uint32_t node;
    std::uint32_t next;
  };

  void enter(std::uint32_t node) {
    index_[node] = low_[node] = counter_++;
    stack_.push_back(node);
    on_stack_[node] = true;
    frames_.push_back({node, graph_->first[node]});
  }

  void visit(std::uint32_t root) {
    enter(root);
    while (!frames_.empty()) {
      Frame& frame = frames_.back();
      const std::uint32_t node = frame.node;
      if (frame.next < graph_->first[node + 1]) {
        const std::uint32_t other = graph_->needed[frame.next++];
        if (scope_[other] != current_scope_) continue;
        if (index_[other] == kUnvisited) {
          enter(other);
        } else if (on_stack_[other]) {
          low_[node] = std::min(low_[node], index_[other]);
        }
        continue;
      }
      frames_.pop_back();
      if (!frames_.empty()) low_[frames_.back().node] = std::min(low_[frames_.back().node], low_[node]);
      if (low_[node] == index_[node]) close(node);
    }
  }

  void close(std::uint32_t root) {
    Component component;
    while (true) {
      const std::uint32_t member = stack_.back();
      stack_.pop_back();
      on_stack_[member] = false;
      component.push_back(member);
      if (member == root) break;
    }
    std::sort(component.begin(), component.end());
    components_.push_back(std::move(component));
  }

  const Dependencies* graph_;
  std::vector<std::uint32_t> scope_;
  std::vector<std::uint32_t> index_, low_;
  std::vector<bool> on_stack_;
  std::vector<std::uint32_t> stack_;
  std::vector<Frame> frames_;
  std::vector<Component> components_;
  std::uint32_t current_scope_ = 0;
  std::uint32_t counter_ = 0;
};

bool needs_itself(const Dependencies& graph, std::uint32_t node) {
  const auto begin = graph.needed.begin() + graph.first[node];
  const auto end = graph.needed.begin() + graph.first[node + 1];
  return std::find(begin, end, node) != end;
}

/// The member of a cycle with the largest product of incoming and outgoing wires inside it.
std::uint32_t choose_tear(const Dependencies& graph, const Component& cycle) {
  std::vector<std::uint64_t> incoming(cycle.size(), 0), outgoing(cycle.size(), 0);
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    for (std::uint32_t k = graph.first[cycle[i]]; k < graph.first[cycle[i] + 1]; ++k) {
      const auto found = std::lower_bound(cycle.begin(), cycle.end(), graph.needed[k]);
      if (found == cycle.end() || *found != graph.needed[k]) continue;
      ++incoming[i];
      ++outgoing[static_cast<std::size_t>(found - cycle.begin())];
    }
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < cycle.size(); ++i) {
    if (incoming[i] * outgoing[i] > incoming[best] * outgoing[best]) best = i;
  }
  return cycle[best];
}

/// Adds the members of a loop to `step`: in `inner` where what they need is known or torn, else in `tears`.
void break_cycles(const Dependencies& graph, ComponentFinder& finder, const Component& members,
                  OrderStep& step) {
  std::vector<Component> waiting;  // the next one last
  const auto wait = [&](std::vector<Component> components) {
    waiting.insert(waiting.end(), std::make_move_iterator(components.rbegin()),
                   std::make_move_iterator(components.rend()));
  };
  wait(finder.find(members));
  while (!waiting.empty()) {
    Component component = std::move(waiting.back());
    waiting.pop_back();
    if (component.size() == 1 && !needs_itself(graph, component[0])) {
      step.inner.push_back(component[0]);
      continue;
    }
    const std::uint32_t tear = choose_tear(graph, component);
    step.tears.push_back(tear);
    component.erase(std::find(component.begin(), component.end(), tear));
    wait(finder.find(component));
  }
}

}  // namespace

void Dependencies::add_row(const std::vector<std::uint32_t>& row) {
  needed.insert(needed.end(), row.begin(), row.end());
  first.push_back(static_cast<std::uint32_t>(needed.size()));
}

std::vector<OrderStep> dependency_order(const Dependencies& dependencies, const std::vector<bool>& implicit) {
  Component all(dependencies.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  ComponentFinder finder(dependencies);
  std::vector<OrderStep> order;
  for (const Component& component : finder.find(all)) {
    OrderStep& step = order.emplace_back();
    Component explicit_members;
    for (const std::uint32_t member : component) {
      (implicit[member] ? step.tears : explicit_members).push_back(member);
    }
    break_cycles(dependencies, finder, explicit_members, step);
    std::sort(step.tears.begin(), step.tears.end());
  }
  return order;
}

}  // namespace oblique::network
