// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/mode_assembly.h>

#include <map>
#include <string>

#include <fmt/format.h>

#include <oblique/network/assembly/switch_assembly.h>

namespace oblique::network {

void make_modes(Assembly& a) {
  constexpr auto kOperate = static_cast<double>(diagram::OperatingMode::operate);
  for (const diagram::FlatGroup& group : a.diagram.timeline.groups) {
    const std::uint32_t mode = a.new_discrete_state("mode of group " + group.name, kOperate);
    a.network.mode_states.push_back(mode);
    Assembly::ModeLines lines;
    ExpressionGraph& graph = a.network.graph;
    const auto line = [&](const std::optional<diagram::SignalRef>& signal, std::string_view name) {
      if (!signal) return graph.constant(0);
      const std::uint32_t discrete_state =
          a.new_discrete_state(fmt::format("{} line of group {}", name, group.name), 0);
      a.mode_lines.push_back({discrete_state, *signal, group.name});
      return graph.discrete_state(discrete_state);
    };
    const auto inverse = [&](NodeId node) { return graph.apply(Op::subtract, graph.constant(1), node); };
    const auto is = [&](diagram::OperatingMode asked) {
      return graph.apply(Op::equal, graph.discrete_state(mode), graph.constant(static_cast<double>(asked)));
    };
    const auto either = [&](NodeId one, NodeId other) {
      return inverse(graph.apply(Op::multiply, inverse(one), inverse(other)));
    };
    lines.initial = either(line(group.initial, "initial"),
                           either(is(diagram::OperatingMode::potset), is(diagram::OperatingMode::initial)));
    lines.hold = graph.apply(Op::multiply, inverse(lines.initial),
                             either(line(group.hold, "hold"), is(diagram::OperatingMode::hold)));
    lines.operate = graph.apply(Op::multiply, inverse(lines.initial), inverse(lines.hold));
    a.modes.push_back(lines);
  }
}

std::optional<NodeId> mode_node(const Assembly& a, std::size_t block, std::string_view name) {
  if (a.modes.empty()) return std::nullopt;
  const Assembly::ModeLines& lines = a.modes[a.diagram.blocks[block].group];
  if (name == "in_initial") return lines.initial;
  if (name == "in_operate") return lines.operate;
  if (name == "in_hold") return lines.hold;
  return std::nullopt;
}

void define_mode_lines(Assembly& a) {
  for (const Assembly::ModeLine& line : a.mode_lines) {
    add_switch(a, {line.discrete_state, fmt::format("group {}", line.group),
                   a.diagram.signal_name(line.signal) + " > 0.5",
                   a.network.graph.apply(Op::subtract, a.quantities[a.quantity_of(line.signal)].node,
                                         a.network.graph.constant(0.5))});
  }
}

void define_phase_ends(Assembly& a) {
  std::map<std::string, NodeId> known;  // phases that end by one condition have one switch
  for (const diagram::FlatPhase& phase : a.diagram.timeline.phases) {
    if (!phase.until) {
      a.network.phase_ends.push_back(a.network.graph.constant(0));
      continue;
    }
    const diagram::FlatCondition& until = *phase.until;
    const std::string condition = fmt::format("{} {} {}", a.diagram.signal_name(until.signal),
                                              until.above ? ">" : "<", until.threshold);
    const auto [end, is_new] = known.try_emplace(condition);
    if (is_new) {
      const NodeId signal = a.quantities[a.quantity_of(until.signal)].node;
      const NodeId threshold = a.network.graph.constant(until.threshold);
      const std::uint32_t discrete_state = a.new_discrete_state("end of a phase", 0);
      add_switch(a, {discrete_state, "timeline", condition,
                     until.above ? a.network.graph.apply(Op::subtract, signal, threshold)
                                 : a.network.graph.apply(Op::subtract, threshold, signal)});
      end->second = a.network.graph.discrete_state(discrete_state);
    }
    a.network.phase_ends.push_back(end->second);
  }
}

}  // namespace oblique::network
