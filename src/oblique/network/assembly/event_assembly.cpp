// SPDX-License-Identifier: MIT
// The part of Assembler that makes modes of operation, memories, events, switches and tables.
#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <oblique/network/assembly/assembler.h>
#include <oblique/text/expression_printer.h>

namespace oblique::network {

std::uint32_t Assembler::new_memory(std::string name, double start) {
  network_.memories.push_back({std::move(name), start});
  return static_cast<std::uint32_t>(network_.memories.size() - 1);
}

/// A memory for the mode of each group, and a switch for each of its mode lines.
void Assembler::make_modes() {
  constexpr auto kOperate = static_cast<double>(diagram::OperatingMode::operate);
  for (const diagram::FlatGroup& group : diagram_.timeline.groups) {
    const std::uint32_t mode = new_memory("mode of group " + group.name, kOperate);
    network_.mode_memories.push_back(mode);
    ModeLines lines;
    ExpressionGraph& graph = network_.graph;
    const auto line = [&](const std::optional<diagram::SignalRef>& signal, std::string_view name) {
      if (!signal) return graph.constant(0);
      const std::uint32_t memory = new_memory(fmt::format("{} line of group {}", name, group.name), 0);
      mode_lines_.push_back({memory, *signal, group.name});
      return graph.memory(memory);
    };
    const auto inverse = [&](NodeId node) { return graph.apply(Op::subtract, graph.constant(1), node); };
    const auto is = [&](diagram::OperatingMode asked) {
      return graph.apply(Op::equal, graph.memory(mode), graph.constant(static_cast<double>(asked)));
    };
    const auto either = [&](NodeId a, NodeId b) {
      return inverse(graph.apply(Op::multiply, inverse(a), inverse(b)));
    };
    lines.initial = either(line(group.initial, "initial"),
                           either(is(diagram::OperatingMode::potset), is(diagram::OperatingMode::initial)));
    lines.hold = graph.apply(Op::multiply, inverse(lines.initial),
                             either(line(group.hold, "hold"), is(diagram::OperatingMode::hold)));
    lines.operate = graph.apply(Op::multiply, inverse(lines.initial), inverse(lines.hold));
    modes_.push_back(lines);
  }
}

void Assembler::define_mode_lines() {
  for (const ModeLine& line : mode_lines_) {
    add_switch({line.memory, fmt::format("group {}", line.group),
                diagram_.signal_name(line.signal) + " > 0.5",
                network_.graph.apply(Op::subtract, quantities_[quantity_of(line.signal)].node,
                                     network_.graph.constant(0.5))});
  }
}

void Assembler::define_phase_ends() {
  for (const diagram::FlatPhase& phase : diagram_.timeline.phases) {
    if (!phase.until) {
      network_.phase_ends.push_back(network_.graph.constant(0));
      continue;
    }
    const diagram::FlatCondition& until = *phase.until;
    const NodeId signal = quantities_[quantity_of(until.signal)].node;
    const NodeId threshold = network_.graph.constant(until.threshold);
    const std::uint32_t memory = new_memory("end of a phase", 0);
    add_switch({memory, "timeline",
                fmt::format("{} {} {}", diagram_.signal_name(until.signal), until.above ? ">" : "<",
                            until.threshold),
                until.above ? network_.graph.apply(Op::subtract, signal, threshold)
                            : network_.graph.apply(Op::subtract, threshold, signal)});
    network_.phase_ends.push_back(network_.graph.memory(memory));
  }
}

void Assembler::add_switch(Switch made) {
  made.rate = rate_of(made.surface);
  network_.memories[made.memory].name = made.block + ": " + made.comparison;
  network_.switches.push_back(std::move(made));
}

/// The node of a mode of operation; nothing for another name, or where there is no timeline.
std::optional<NodeId> Assembler::mode_node(std::size_t block, std::string_view name) const {
  if (modes_.empty()) return std::nullopt;
  const ModeLines& lines = modes_[diagram_.blocks[block].group];
  if (name == "in_initial") return lines.initial;
  if (name == "in_operate") return lines.operate;
  if (name == "in_hold") return lines.hold;
  return std::nullopt;
}

/// Events that can never come are left out, and memories that no event sets are constants.
void Assembler::find_active_events() {
  for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
    for (const diagram::EventRule& rule : diagram_.blocks[b].definition->events) {
      if (rule.where && constant_value(b, *rule.where).value_or(0) == 0) continue;
      const auto always = constant_value(b, rule.when);
      if (always && (*always == 0 || !rule.at_start)) continue;
      active_events_.emplace_back(b, &rule);
    }
  }
}

void Assembler::make_memories() {
  first_memory_.assign(diagram_.blocks.size(), kNone);
  std::vector<bool> set(diagram_.blocks.size(), false);
  for (const auto& [block, rule] : active_events_) set[block] = true;
  for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
    const diagram::FlatBlock& block = diagram_.blocks[b];
    if (!set[b]) continue;
    first_memory_[b] = static_cast<std::uint32_t>(network_.memories.size());
    for (const diagram::MemoryRule& memory : block.definition->memories) {
      const double start = constant_value(b, memory.initial).value_or(0);
      if (!std::isfinite(start)) {
        diagnostics_.add({block.place,
                          fmt::format("'{}.{}' would start at {}", block.path, memory.name, start),
                          "a finite start value",
                          {}});
      }
      network_.memories.push_back({block.path + "." + memory.name, start});
    }
  }
}

/// A memory of a block: its node, or its initial value where nothing ever sets it.
NodeId Assembler::memory_node(std::size_t block, std::size_t memory) {
  if (first_memory_[block] != kNone)
    return network_.graph.memory(first_memory_[block] + static_cast<std::uint32_t>(memory));
  const text::Expression& initial = diagram_.blocks[block].definition->memories[memory].initial;
  return network_.graph.constant(constant_value(block, initial).value_or(0));
}

void Assembler::make_events() {
  for (const auto& [block, rule] : active_events_) {
    Event event;
    event.block = diagram_.blocks[block].path;
    event.at_start = rule->at_start;
    event.condition = built(block, rule->when, rule->place, "an event's 'when'");
    event.actions = actions_of(block, rule->actions);
    if (!rule->piling_up.empty()) {
      event.piling_up = network_.events.size();
      network_.events.push_back(
          {event.block, network_.graph.constant(0), false, false, actions_of(block, rule->piling_up)});
    }
    network_.events.push_back(std::move(event));
  }
}

std::vector<Event::Action> Assembler::actions_of(std::size_t block,
                                                 const std::vector<diagram::EventAction>& rules) {
  std::vector<Event::Action> actions;
  for (const diagram::EventAction& rule : rules) {
    Event::Action done;
    const auto memory = diagram_.blocks[block].definition->find_memory(rule.target);
    done.on_state = !memory;
    done.index = memory ? first_memory_[block] + static_cast<std::uint32_t>(*memory)
                        : quantities_[quantity_of(block, rule.target)].variable_index;
    done.value = built(block, rule.value, rule.place, "an event's '" + rule.target + "'");
    actions.push_back(done);
  }
  return actions;
}

void Assembler::make_starts() {
  for (const Quantity& quantity : quantities_) {
    if (quantity.equation->kind != diagram::Equation::Kind::derivative) continue;
    const diagram::StartRule& rule = start_of(quantity);
    const BlockContext context(*this, quantity.block);
    if (change_of(rule.value, context) == ExpressionContext::Change::never) continue;
    const NodeId value = built(quantity.block, rule.value, quantity.equation->place, "the start value");
    State& state = network_.states[quantity.variable_index];
    // A potentiometer at the reference gives a number: loops can be solved with it from the beginning.
    if (network_.graph[value].op == Op::constant) {
      state.start = network_.graph[value].value;
    } else {
      state.start_node = value;
    }
  }
}

/// The surfaces of all switches; building one may call for another.
void Assembler::define_switches() {
  std::size_t next = 0;
  while (next < pending_switches_.size()) {
    const PendingSwitch pending = pending_switches_[next++];
    const NodeId left = built(pending.block, pending.left, pending.place, "a comparison");
    const NodeId right = built(pending.block, pending.right, pending.place, "a comparison");
    Switch made;
    made.memory = pending.memory;
    made.block = diagram_.blocks[pending.block].path;
    made.comparison = network_.memories[pending.memory].name;
    made.surface = network_.graph.apply(Op::subtract, left, right);
    made.turning = pending.turning;
    if (const auto& interval = diagram_.blocks[pending.block].definition->check_interval)
      made.check_interval = constant_value(pending.block, *interval).value_or(made.check_interval);
    add_switch(std::move(made));
  }
}

/// d surface/dt where nothing but time enters and that rate is constant between events.
std::optional<NodeId> Assembler::rate_of(NodeId surface) {
  if (!follows_time_alone(surface)) return std::nullopt;
  const NodeId rate = rates_by_time_.of(surface);
  if (network_.graph[rate].continuous || network_.graph.is_constant(rate, 0)) return std::nullopt;
  return rate;
}

bool Assembler::follows_time_alone(NodeId id) {
  const ExpressionGraph& graph = network_.graph;
  for (auto next = static_cast<NodeId>(beside_time_.size()); next <= id; ++next) {
    const Node& node = graph[next];
    bool beside = node.op == Op::variable && node.variable != 0;
    for (int i = 0; i < operand_count(node.op); ++i) beside = beside || beside_time_[node.operand(i)];
    beside_time_.push_back(beside);
  }
  return graph[id].continuous && !beside_time_[id];
}

NodeId Assembler::switch_of(std::size_t block, const text::Expression& left, const text::Expression& right,
                            Turning turning) {
  std::string text = text::to_string(left) + " > " + text::to_string(right);
  const auto added = switch_index_.try_emplace(std::pair(block, text), kNone);
  std::uint32_t& memory = added.first->second;
  if (added.second) {
    memory = static_cast<std::uint32_t>(network_.memories.size());
    network_.memories.push_back({std::move(text), 0});
    pending_switches_.push_back({block, left, right, memory, diagram_.blocks[block].place, turning});
  } else {
    const auto pending = std::find_if(pending_switches_.begin(), pending_switches_.end(),
                                      [&](const PendingSwitch& p) { return p.memory == memory; });
    if (pending != pending_switches_.end()) pending->turning = std::max(pending->turning, turning);
  }
  return network_.graph.memory(memory);
}

/// table(x, x1, y1, …): the segment is a memory that follows x across the ends of segments.
NodeId Assembler::interpolated(std::size_t block, const text::Expression& call) {
  text::PointTable table;
  if (call.operands.size() == 2 && call.operands[1].kind == text::Expression::Kind::name) {
    const diagram::FlatBlock& flat = diagram_.blocks[block];
    const auto parameter = flat.definition->find_parameter(call.operands[1].name);
    if (parameter && flat.definition->parameters[*parameter].points)
      return interpolate(block, call, flat.points[*parameter]);
  }
  if (call.operands.size() < 5 || call.operands.size() % 2 == 0) {
    throw text::ExpressionError{
        call.column,
        "table() has an incomplete point",
        "table(x, x1, y1, x2, y2, …), or table(x, points) with a parameter of kind points",
        {}};
  }
  for (std::size_t i = 1; i + 1 < call.operands.size(); i += 2) {
    const auto x = constant_value(block, call.operands[i]), y = constant_value(block, call.operands[i + 1]);
    if (!x || !y)
      throw text::ExpressionError{
          call.column, "a point of the table varies", "points of numbers and parameters", {}};
    table.x.push_back(*x);
    table.y.push_back(*y);
  }
  return interpolate(block, call, std::move(table));
}

/// A table with a few jumps is one without them and a step at each: a step can be slid along.
NodeId Assembler::interpolate(std::size_t block, const text::Expression& call, text::PointTable table) {
  // A recording may have thousands, of the time, which slides along none.
  constexpr std::size_t kMostSteps = 32;
  const std::vector<double>& x = table.x;
  if (!std::is_sorted(x.begin(), x.end()) || x[0] == x[1] || x[x.size() - 2] == x.back()) {
    throw text::ExpressionError{call.column,
                                "the x of a table do not rise from point to point",
                                "x1 < x2 ≤ x3 < …, where two that are equal make a jump",
                                {}};
  }
  struct Step {
    double x, height;
  };
  std::vector<Step> steps;
  text::PointTable joined;
  double risen = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (k > 0 && x[k] == x[k - 1]) {
      steps.push_back({table.x[k], table.y[k] - table.y[k - 1]});
      risen += steps.back().height;
    } else {
      joined.x.push_back(table.x[k]);
      joined.y.push_back(table.y[k] - risen);
    }
  }
  const bool apart = !steps.empty() && steps.size() <= kMostSteps;
  NodeId sum = interpolate_by_segments(block, call, apart ? std::move(joined) : std::move(table));
  if (!apart) return sum;
  for (const Step& step : steps) {
    text::Expression at;
    at.number = step.x;
    text::Expression beyond;
    beyond.kind = text::Expression::Kind::greater_equal;
    beyond.operands = {call.operands[0], at};
    sum = network_.graph.apply(Op::add, sum,
                               network_.graph.apply(Op::multiply, network_.graph.constant(step.height),
                                                    built_operand(block, beyond)));
  }
  return sum;
}

NodeId Assembler::interpolate_by_segments(std::size_t block, const text::Expression& call,
                                          text::PointTable table) {
  ExpressionGraph& graph = network_.graph;
  const auto [found, inserted] = table_index_.try_emplace(std::pair(block, text::to_string(call)), kNone);
  if (inserted) {
    found->second = static_cast<std::uint32_t>(network_.tables.size());
    network_.tables.push_back(std::move(table));
    const auto segment = static_cast<std::uint32_t>(network_.memories.size());
    network_.memories.push_back({diagram_.blocks[block].path + ": segment", 0});
    pending_tables_.push_back(
        {block, call.operands[0], found->second, segment, diagram_.blocks[block].place});
  }
  const std::uint32_t chosen = found->second;
  const NodeId number = graph.constant(chosen);
  const NodeId x = built_operand(block, call.operands[0]);
  const auto& pending = *std::find_if(pending_tables_.begin(), pending_tables_.end(),
                                      [&](const PendingTable& p) { return p.table == chosen; });
  return graph.apply(Op::table_value, x, graph.memory(pending.segment), number);
}

NodeId Assembler::built_operand(std::size_t block, const text::Expression& expression) {
  BlockContext context(*this, block);
  return build_expression(network_.graph, expression, context);
}

/// Two switches and two events move each table's segment along.
void Assembler::define_tables() {
  ExpressionGraph& graph = network_.graph;
  std::size_t next_table = 0;
  while (next_table < pending_tables_.size()) {
    const PendingTable pending = pending_tables_[next_table++];
    const NodeId x = built(pending.block, pending.x, pending.place, "a table's argument");
    const NodeId number = graph.constant(pending.table);
    const NodeId segment = graph.memory(pending.segment);
    const NodeId found = graph.apply(Op::table_segment, x, number);
    for (const bool up : {true, false}) {
      const NodeId edge = graph.apply(up ? Op::table_end : Op::table_begin, segment, number);
      Switch made;
      made.memory = new_memory({}, 0);
      made.block = diagram_.blocks[pending.block].path;
      made.comparison = text::to_string(pending.x) + (up ? " after its segment" : " before its segment");
      made.surface = up ? graph.apply(Op::subtract, x, edge) : graph.apply(Op::subtract, edge, x);
      made.turning = Turning::bends;
      // At least to the next one, which rounding may hide from the search.
      const NodeId next = graph.apply(up ? Op::add : Op::subtract, segment, graph.constant(1));
      const NodeId farther = up ? graph.apply(Op::less, next, found) : graph.apply(Op::less, found, next);
      Event event;
      event.block = made.block;
      event.condition = graph.memory(made.memory);
      event.repeats = true;
      event.actions.push_back({false, pending.segment, graph.apply(Op::select, farther, found, next)});
      add_switch(std::move(made));
      network_.events.push_back(std::move(event));
    }
  }
}

}  // namespace oblique::network
