// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/plan.h>

#include <algorithm>
#include <map>

namespace oblique::draw::layered {
namespace {

class Planner {
 public:
  Planner(const LayoutGraph& graph, const std::vector<std::size_t>& layers) : graph_(graph) {
    const std::size_t n = layers.empty() ? 0 : *std::max_element(layers.begin(), layers.end()) + 1;
    plan_.layers.resize(n);
    plan_.channels.resize(n + 1);
    for (std::size_t v = 0; v < graph.nodes.size(); ++v)
      add_slot({v, 0, layers[v], graph.nodes[v].size.y(), 0});
  }

  Plan plan() {
    std::map<std::pair<std::size_t, std::size_t>, std::vector<const LayoutWire*>> nets;
    for (const LayoutWire& wire : graph_.wires) nets[{wire.from, wire.output}].push_back(&wire);
    for (const auto& [source, wires] : nets) {
      plan_.nets.push_back(source);
      add_net(source, wires);
    }
    return std::move(plan_);
  }

 private:
  std::size_t add_slot(const Slot& slot) {
    plan_.slots.push_back(slot);
    plan_.layers[slot.layer].push_back(plan_.slots.size() - 1);
    return plan_.slots.size() - 1;
  }

  std::size_t add_passing(std::size_t layer) {
    return add_slot({Slot::kPassing, plan_.nets.size() - 1, layer, 0, 0});
  }

  void add_net(const std::pair<std::size_t, std::size_t>& source,
               const std::vector<const LayoutWire*>& wires) {
    const std::size_t start = plan_.slots[source.first].layer;
    std::map<std::size_t, std::vector<Pin>> sinks;  // by layer
    int weight = 1;
    for (const LayoutWire* const wire : wires) {
      sinks[plan_.slots[wire->to].layer].push_back(
          {wire->to, graph_.nodes[wire->to].inputs[wire->input], false});
      weight = std::max(weight, wire->weight);
      if (plan_.slots[wire->to].layer <= start) ++plan_.feedbacks;
    }
    const auto branch = [&](Pin from) { return Branch{plan_.nets.size() - 1, {from}, weight}; };
    const auto add_sinks = [&](Branch& b, std::size_t layer) {
      if (const auto found = sinks.find(layer); found != sinks.end())
        b.pins.insert(b.pins.end(), found->second.begin(), found->second.end());
    };
    const Pin origin{source.first, graph_.nodes[source.first].outputs[source.second], true};
    Branch first = branch(origin);
    const std::size_t last = sinks.rbegin()->first, begin = sinks.begin()->first;
    // back along the layers from that of the source to the first one with a sink
    if (begin <= start) {
      std::size_t passing = add_passing(start);
      first.pins.push_back({passing, 0, true});
      for (std::size_t layer = start;; --layer) {
        Branch back = branch({passing, 0, false});
        add_sinks(back, layer);
        if (layer > begin) {
          passing = add_passing(layer - 1);
          back.pins.push_back({passing, 0, true});
        }
        plan_.channels[layer].push_back(std::move(back));
        if (layer == begin) break;
      }
    }
    // and forward
    Branch along = std::move(first);
    for (std::size_t layer = start + 1; layer <= last; ++layer) {
      add_sinks(along, layer);
      if (layer == last) break;
      const std::size_t passing = add_passing(layer);
      along.pins.push_back({passing, 0, false});
      plan_.channels[layer].push_back(std::move(along));
      along = branch({passing, 0, true});
    }
    plan_.channels[std::max(start + 1, last)].push_back(std::move(along));
  }

  const LayoutGraph& graph_;
  Plan plan_;
};

}  // namespace

Plan make_plan(const LayoutGraph& graph, const std::vector<std::size_t>& layers) {
  return Planner(graph, layers).plan();
}

}  // namespace oblique::draw::layered
