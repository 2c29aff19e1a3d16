// SPDX-License-Identifier: MIT
#include <oblique/network/network.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <oblique/network/dependency_order.h>
#include <oblique/network/expression_builder.h>

namespace oblique {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A quantity that some block's equation defines.
struct Quantity {
  std::size_t block;
  const Equation* equation;
  std::uint32_t variable_index = kNone;  ///< of the state or unknown
  NodeId node = kNone;                   ///< once known
};

class Assembler {
 public:
  explicit Assembler(const FlatDiagram& diagram) : diagram_(diagram) {}

  Network assemble() {
    collect_quantities();
    make_modes();
    find_active_events();
    make_memories();
    make_states();
    for (const OrderStep& step : dependency_order(dependencies_of_algebra(), implicit_marks())) define(step);
    for (Quantity& quantity : quantities_) {
      if (quantity.equation->kind == Equation::Kind::derivative) {
        network_.states[quantity.variable_index].derivative = finite(quantity, expression_of(quantity));
      }
    }
    collect_signals();
    make_events();
    make_starts();
    define_mode_lines();
    define_phase_ends();
    define_switches();
    define_tables();
    diagnostics_.throw_if_any<NetworkError>();
    return std::move(network_);
  }

 private:
  // --- names
  // -------------------------------------------------------------------------------------------------

  const FlatBlock& block_of(const Quantity& quantity) const { return diagram_.blocks[quantity.block]; }

  std::string name_of(const Quantity& quantity) const {
    const FlatBlock& block = block_of(quantity);
    const auto output = block.definition->find_output(quantity.equation->target);
    if (output) return diagram_.signal_name({quantity.block, *output});
    return block.path + "." + quantity.equation->target;
  }

  std::uint32_t quantity_of(std::size_t block, std::string_view target) const {
    for (std::uint32_t q = first_quantity_[block]; q < first_quantity_[block + 1]; ++q) {
      if (quantities_[q].equation->target == target) return q;
    }
    return kNone;
  }

  std::uint32_t quantity_of(SignalRef signal) const {
    return quantity_of(signal.block, diagram_.blocks[signal.block].definition->outputs[signal.output].name);
  }

  // --- quantities, states, dependencies
  // ----------------------------------------------------------------------

  void collect_quantities() {
    first_quantity_.reserve(diagram_.blocks.size() + 1);
    for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
      first_quantity_.push_back(static_cast<std::uint32_t>(quantities_.size()));
      for (const Equation& equation : diagram_.blocks[b].behaviour->equations)
        quantities_.push_back({b, &equation});
    }
    first_quantity_.push_back(static_cast<std::uint32_t>(quantities_.size()));
  }

  void make_states() {
    for (Quantity& quantity : quantities_) {
      if (quantity.equation->kind != Equation::Kind::derivative) continue;
      const StartRule& rule = start_of(quantity);
      quantity.variable_index = static_cast<std::uint32_t>(network_.states.size());
      const BlockContext context(*this, quantity.block);
      const bool fixed = change_of(rule.value, context) == ExpressionContext::Change::never;
      const double start = fixed ? start_value(quantity, rule) : 0;
      network_.states.push_back(
          {name_of(quantity), start, rule.at_rest, 0, block_of(quantity).tolerance, {}});
      quantity.node = network_.graph.variable(network_.state_variable(quantity.variable_index));
    }
  }

  const StartRule& start_of(const Quantity& quantity) const {
    const auto& starts = block_of(quantity).definition->starts;
    return *std::find_if(starts.begin(), starts.end(),
                         [&](const StartRule& rule) { return rule.target == quantity.equation->target; });
  }

  double start_value(const Quantity& quantity, const StartRule& rule) {
    const FlatBlock& block = block_of(quantity);
    const double value = constant_value(quantity.block, rule.value).value_or(0);
    if (!std::isfinite(value)) {
      diagnostics_.add({block.place, fmt::format("'{}' would start at {}", name_of(quantity), value),
                        "a finite start value", "give the block another 'initial'"});
    }
    return value;
  }

  static std::optional<double> constant_of(const FlatBlock& block, std::string_view name) {
    if (name == "polarity") return block.polarity;
    if (const auto parameter = block.definition->find_parameter(name)) return block.parameters[*parameter];
    if (const auto input = block.definition->find_input(name); input && block.inputs[*input].terms.empty())
      return block.inputs[*input].constant;
    if (name == "in_operate") return 1;  // where there is a timeline, these are asked for earlier
    if (name == "in_initial" || name == "in_hold") return 0;
    return std::nullopt;
  }

  /// The value of an expression that never changes; nothing for another.
  std::optional<double> constant_value(std::size_t block, const Expression& expression) {
    BlockContext context(*this, block);
    if (change_of(expression, context) != ExpressionContext::Change::never) return std::nullopt;
    return network_.graph[build_expression(network_.graph, expression, context)].value;
  }

  // --- modes of operation
  // -------------------------------------------------------------------------------------------------------------

  std::uint32_t new_memory(std::string name, double start) {
    network_.memories.push_back({std::move(name), start});
    return static_cast<std::uint32_t>(network_.memories.size() - 1);
  }

  /// A memory for the mode of each group, and a switch for each of its mode lines.
  void make_modes() {
    constexpr auto kOperate = static_cast<double>(OperatingMode::operate);
    for (const FlatGroup& group : diagram_.timeline.groups) {
      const std::uint32_t mode = new_memory("mode of group " + group.name, kOperate);
      network_.mode_memories.push_back(mode);
      ModeLines lines;
      ExpressionGraph& graph = network_.graph;
      const auto line = [&](const std::optional<SignalRef>& signal, std::string_view name) {
        if (!signal) return graph.constant(0);
        const std::uint32_t memory = new_memory(fmt::format("{} line of group {}", name, group.name), 0);
        mode_lines_.push_back({memory, *signal, group.name});
        return graph.memory(memory);
      };
      const auto inverse = [&](NodeId node) { return graph.apply(Op::subtract, graph.constant(1), node); };
      const auto is = [&](OperatingMode asked) {
        return graph.apply(Op::equal, graph.memory(mode), graph.constant(static_cast<double>(asked)));
      };
      const auto either = [&](NodeId a, NodeId b) {
        return inverse(graph.apply(Op::multiply, inverse(a), inverse(b)));
      };
      lines.initial = either(line(group.initial, "initial"),
                             either(is(OperatingMode::potset), is(OperatingMode::initial)));
      lines.hold = graph.apply(Op::multiply, inverse(lines.initial),
                               either(line(group.hold, "hold"), is(OperatingMode::hold)));
      lines.operate = graph.apply(Op::multiply, inverse(lines.initial), inverse(lines.hold));
      modes_.push_back(lines);
    }
  }

  void define_mode_lines() {
    for (const ModeLine& line : mode_lines_) {
      add_switch({line.memory, fmt::format("group {}", line.group),
                  diagram_.signal_name(line.signal) + " > 0.5",
                  network_.graph.apply(Op::subtract, quantities_[quantity_of(line.signal)].node,
                                       network_.graph.constant(0.5))});
    }
  }

  void define_phase_ends() {
    for (const FlatPhase& phase : diagram_.timeline.phases) {
      if (!phase.until) {
        network_.phase_ends.push_back(network_.graph.constant(0));
        continue;
      }
      const FlatCondition& until = *phase.until;
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

  void add_switch(Switch made) {
    made.rate = rate_of(made.surface);
    network_.memories[made.memory].name = made.block + ": " + made.comparison;
    network_.switches.push_back(std::move(made));
  }

  /// The node of a mode of operation; nothing for another name, or where there is no timeline.
  std::optional<NodeId> mode_node(std::size_t block, std::string_view name) const {
    if (modes_.empty()) return std::nullopt;
    const ModeLines& lines = modes_[diagram_.blocks[block].group];
    if (name == "in_initial") return lines.initial;
    if (name == "in_operate") return lines.operate;
    if (name == "in_hold") return lines.hold;
    return std::nullopt;
  }

  // --- memories, events, switches
  // ----------------------------------------------------------------------------------------------------

  /// Events that can never come are left out, and memories that no event sets are constants.
  void find_active_events() {
    for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
      for (const EventRule& rule : diagram_.blocks[b].definition->events) {
        if (rule.where && constant_value(b, *rule.where).value_or(0) == 0) continue;
        const auto always = constant_value(b, rule.when);
        if (always && (*always == 0 || !rule.at_start)) continue;
        active_events_.emplace_back(b, &rule);
      }
    }
  }

  void make_memories() {
    first_memory_.assign(diagram_.blocks.size(), kNone);
    std::vector<bool> set(diagram_.blocks.size(), false);
    for (const auto& [block, rule] : active_events_) set[block] = true;
    for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
      const FlatBlock& block = diagram_.blocks[b];
      if (!set[b]) continue;
      first_memory_[b] = static_cast<std::uint32_t>(network_.memories.size());
      for (const MemoryRule& memory : block.definition->memories) {
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
  NodeId memory_node(std::size_t block, std::size_t memory) {
    if (first_memory_[block] != kNone)
      return network_.graph.memory(first_memory_[block] + static_cast<std::uint32_t>(memory));
    const Expression& initial = diagram_.blocks[block].definition->memories[memory].initial;
    return network_.graph.constant(constant_value(block, initial).value_or(0));
  }

  void make_events() {
    for (const auto& [block, rule] : active_events_) {
      Event event;
      event.block = diagram_.blocks[block].path;
      event.at_start = rule->at_start;
      event.condition = built(block, rule->when, rule->place, "an event's 'when'");
      for (const EventAction& action : rule->actions) {
        Event::Action done;
        const auto memory = diagram_.blocks[block].definition->find_memory(action.target);
        done.on_state = !memory;
        done.index = memory ? first_memory_[block] + static_cast<std::uint32_t>(*memory)
                            : quantities_[quantity_of(block, action.target)].variable_index;
        done.value = built(block, action.value, action.place, "an event's '" + action.target + "'");
        event.actions.push_back(done);
      }
      network_.events.push_back(std::move(event));
    }
  }

  void make_starts() {
    for (const Quantity& quantity : quantities_) {
      if (quantity.equation->kind != Equation::Kind::derivative) continue;
      const StartRule& rule = start_of(quantity);
      const BlockContext context(*this, quantity.block);
      if (change_of(rule.value, context) == ExpressionContext::Change::never) continue;
      network_.states[quantity.variable_index].start_node =
          built(quantity.block, rule.value, quantity.equation->place, "the start value");
    }
  }

  /// The surfaces of all switches; building one may call for another.
  void define_switches() {
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
      if (const auto& interval = diagram_.blocks[pending.block].definition->check_interval)
        made.check_interval = constant_value(pending.block, *interval).value_or(made.check_interval);
      add_switch(std::move(made));
    }
  }

  /// d surface/dt where nothing but time enters and that rate is constant between events.
  std::optional<NodeId> rate_of(NodeId surface) {
    const auto gradient = network_.graph.gradient(surface);
    if (gradient.size() != 1 || gradient[0].first != 0) return std::nullopt;
    if (network_.graph[gradient[0].second].continuous) return std::nullopt;
    return gradient[0].second;
  }

  NodeId switch_of(std::size_t block, const Expression& left, const Expression& right) {
    std::string text = to_string(left) + " > " + to_string(right);
    const auto [found, inserted] = switch_index_.try_emplace(std::pair(block, text), kNone);
    if (inserted) {
      found->second = static_cast<std::uint32_t>(network_.memories.size());
      network_.memories.push_back({std::move(text), 0});
      pending_switches_.push_back({block, left, right, found->second, diagram_.blocks[block].place});
    }
    return network_.graph.memory(found->second);
  }

  NodeId built(std::size_t block, const Expression& expression, const Place& place, const std::string& what) {
    BlockContext context(*this, block);
    try {
      return build_expression(network_.graph, expression, context);
    } catch (const ExpressionError& error) {
      diagnostics_.add({place, fmt::format("{} of '{}': {}", what, diagram_.blocks[block].path, error.what),
                        error.expected, error.remedy});
      return network_.graph.constant(0);
    }
  }

  bool is_algebraic(std::uint32_t q) const {
    return quantities_[q].equation->kind != Equation::Kind::derivative;
  }

  std::vector<bool> implicit_marks() const {
    std::vector<bool> marks(quantities_.size());
    for (std::size_t q = 0; q < marks.size(); ++q) {
      marks[q] = quantities_[q].equation->kind == Equation::Kind::implicit;
    }
    return marks;
  }

  /// States need nothing: their rows are empty, which also keeps them out of every loop.
  Dependencies dependencies_of_algebra() const {
    Dependencies dependencies;
    std::vector<std::uint32_t> row;
    for (std::uint32_t q = 0; q < quantities_.size(); ++q) {
      row.clear();
      if (is_algebraic(q)) collect_needed(quantities_[q].block, quantities_[q].equation->expression, row);
      dependencies.add_row(row);
    }
    return dependencies;
  }

  /// What is compared is not needed: a switch keeps its position until an event turns it over.
  void collect_needed(std::size_t block, const Expression& e, std::vector<std::uint32_t>& row) const {
    if (is_comparison(e.kind)) return;
    for (const Expression& operand : e.operands) collect_needed(block, operand, row);
    if (e.kind != Expression::Kind::name) return;
    const FlatBlock& flat = diagram_.blocks[block];
    if (const auto input = flat.definition->find_input(e.name)) {
      for (const FlatTerm& term : flat.inputs[*input].terms) {
        const std::uint32_t other = quantity_of(term.signal);
        if (is_algebraic(other)) row.push_back(other);
      }
    } else if (const std::uint32_t own = quantity_of(block, e.name); own != kNone && is_algebraic(own)) {
      row.push_back(own);
    }
  }

  // --- definitions, in order
  // ---------------------------------------------------------------------------------

  void define(const OrderStep& step) {
    if (step.tears.empty()) {
      for (const std::uint32_t q : step.inner) {
        if (is_algebraic(q)) quantities_[q].node = finite(quantities_[q], expression_of(quantities_[q]));
      }
      return;
    }
    Loop& loop = network_.loops.emplace_back();
    for (const std::uint32_t q : step.tears) {
      Quantity& quantity = quantities_[q];
      const bool torn = quantity.equation->kind == Equation::Kind::assignment;
      quantity.variable_index = static_cast<std::uint32_t>(network_.unknowns.size());
      const double guess = torn ? 0.0 : start_value(quantity, start_of(quantity));
      loop.unknowns.push_back(network_.unknowns.size());
      network_.unknowns.push_back({name_of(quantity), guess, 0, torn, block_of(quantity).place});
      quantity.node = network_.graph.variable(network_.unknown_variable(quantity.variable_index));
    }
    for (const std::uint32_t q : step.inner) quantities_[q].node = expression_of(quantities_[q]);
    for (const std::uint32_t q : step.tears) {
      Quantity& quantity = quantities_[q];
      Unknown& unknown = network_.unknowns[quantity.variable_index];
      unknown.residual = finite(quantity, expression_of(quantity));
      if (unknown.torn)
        unknown.residual = network_.graph.apply(Op::subtract, unknown.residual, quantity.node);
    }
    name_members(step, loop);
  }

  void name_members(const OrderStep& step, Loop& loop) const {
    std::vector<std::size_t> blocks;
    for (const auto* part : {&step.tears, &step.inner}) {
      for (const std::uint32_t q : *part) blocks.push_back(quantities_[q].block);
    }
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    for (const std::size_t b : blocks) loop.members.push_back(diagram_.blocks[b].path);
  }

  NodeId finite(const Quantity& quantity, NodeId node) {
    const ExpressionGraph& graph = network_.graph;
    if (graph.is_constant(node) && !std::isfinite(graph[node].value)) {
      diagnostics_.add(
          {block_of(quantity).place,
           fmt::format("'{}' is {} whatever the signals are", name_of(quantity), graph[node].value),
           "a finite value",
           fmt::format("check the parameters in '{}'", to_string(quantity.equation->expression))});
    }
    return node;
  }

  void collect_signals() {
    for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
      network_.first_signal.push_back(network_.signals.size());
      for (std::size_t output = 0; output < diagram_.blocks[b].definition->outputs.size(); ++output) {
        network_.signals.push_back(quantities_[quantity_of({b, output})].node);
        network_.signal_names.push_back(diagram_.signal_name({b, output}));
      }
    }
  }

  // --- expressions
  // -------------------------------------------------------------------------------------------

  NodeId expression_of(const Quantity& quantity) {
    const Equation& equation = *quantity.equation;
    BlockContext context(*this, quantity.block);
    try {
      return build_expression(network_.graph, equation.expression, context);
    } catch (const ExpressionError& error) {
      diagnostics_.add({equation.place, fmt::format("equation of '{}': {}", name_of(quantity), error.what),
                        error.expected, error.remedy});
      return network_.graph.constant(0);
    }
  }

  NodeId node_of(std::size_t block, std::string_view name) {
    const FlatBlock& flat = diagram_.blocks[block];
    if (const auto input = flat.definition->find_input(name)) return sum_of(flat.inputs[*input]);
    if (const std::uint32_t own = quantity_of(block, name); own != kNone) return quantities_[own].node;
    if (name == "time") return network_.graph.variable(0);
    if (const auto memory = flat.definition->find_memory(name)) return memory_node(block, *memory);
    if (const auto mode = mode_node(block, name)) return *mode;
    return network_.graph.constant(constant_of(flat, name).value());  // parse_block admits no other names
  }

  NodeId sum_of(const FlatInput& input) {
    ExpressionGraph& graph = network_.graph;
    NodeId sum = graph.constant(input.constant);
    for (const FlatTerm& term : input.terms) {
      const NodeId signal = quantities_[quantity_of(term.signal)].node;
      sum = graph.apply(Op::add, sum, graph.apply(Op::multiply, graph.constant(term.weight), signal));
    }
    return sum;
  }

  /// The names of one block's equations.
  class BlockContext final : public ExpressionContext {
   public:
    BlockContext(Assembler& assembler, std::size_t block) : assembler_(assembler), block_(block) {}

    NodeId node_of_name(std::string_view name) override { return assembler_.node_of(block_, name); }

    Change change_of(std::string_view name) const override {
      const FlatBlock& flat = assembler_.diagram_.blocks[block_];
      if (const auto input = flat.definition->find_input(name))
        return flat.inputs[*input].terms.empty() ? Change::never : Change::always;
      if (assembler_.quantity_of(block_, name) != kNone || name == "time") return Change::always;
      if (flat.definition->find_memory(name)) {
        const bool constant = !assembler_.first_memory_.empty() && assembler_.first_memory_[block_] == kNone;
        return constant ? Change::never : Change::with_events;
      }
      if (assembler_.mode_node(block_, name)) return Change::with_events;
      return Change::never;
    }

    NodeId greater(const Expression& left, const Expression& right) override {
      return assembler_.switch_of(block_, left, right);
    }

    NodeId interpolated(const Expression& call) override { return assembler_.interpolated(block_, call); }

    double weights(const Expression& call) const override {
      const FlatBlock& flat = assembler_.diagram_.blocks[block_];
      const auto input = flat.definition->find_input(call.operands[0].name);
      if (!input) throw ExpressionError{call.column, "weights() is of an input", "the name of an input", {}};
      double sum = 0;
      for (const FlatTerm& term : flat.inputs[*input].terms) sum += std::abs(term.weight);
      return sum;
    }

   private:
    Assembler& assembler_;
    std::size_t block_;
  };

  struct PendingSwitch {
    std::size_t block;
    Expression left, right;
    std::uint32_t memory;
    Place place;
  };

  /// table(x, x1, y1, …): the segment is a memory that follows x across the ends of segments.
  NodeId interpolated(std::size_t block, const Expression& call) {
    PointTable table;
    if (call.operands.size() == 2 && call.operands[1].kind == Expression::Kind::name) {
      const FlatBlock& flat = diagram_.blocks[block];
      const auto parameter = flat.definition->find_parameter(call.operands[1].name);
      if (parameter && flat.definition->parameters[*parameter].points)
        return interpolate(block, call, flat.points[*parameter]);
    }
    if (call.operands.size() < 5 || call.operands.size() % 2 == 0) {
      throw ExpressionError{
          call.column,
          "table() has no whole points",
          "table(x, x1, y1, x2, y2, …), or table(x, points) with a parameter of kind points",
          {}};
    }
    for (std::size_t i = 1; i + 1 < call.operands.size(); i += 2) {
      const auto x = constant_value(block, call.operands[i]), y = constant_value(block, call.operands[i + 1]);
      if (!x || !y)
        throw ExpressionError{
            call.column, "a point of the table varies", "points of numbers and parameters", {}};
      table.x.push_back(*x);
      table.y.push_back(*y);
    }
    return interpolate(block, call, std::move(table));
  }

  NodeId interpolate(std::size_t block, const Expression& call, PointTable table) {
    ExpressionGraph& graph = network_.graph;
    const auto [found, inserted] = table_index_.try_emplace(std::pair(block, to_string(call)), kNone);
    if (inserted) {
      if (!std::is_sorted(table.x.begin(), table.x.end(), std::less_equal<>())) {
        throw ExpressionError{
            call.column, "the x of a table do not rise from point to point", "x1 < x2 < …", {}};
      }
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

  NodeId built_operand(std::size_t block, const Expression& expression) {
    BlockContext context(*this, block);
    return build_expression(network_.graph, expression, context);
  }

  struct PendingTable {
    std::size_t block;
    Expression x;
    std::uint32_t table, segment;
    Place place;
  };

  /// Two switches and two events move each table's segment along.
  void define_tables() {
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
        made.comparison = to_string(pending.x) + (up ? " after its segment" : " before its segment");
        made.surface = up ? graph.apply(Op::subtract, x, edge) : graph.apply(Op::subtract, edge, x);
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

  const FlatDiagram& diagram_;
  struct ModeLines {
    NodeId initial, operate, hold;
  };
  struct ModeLine {
    std::uint32_t memory;
    SignalRef signal;
    std::string group;
  };
  std::vector<ModeLines> modes_;  ///< of each group
  std::vector<ModeLine> mode_lines_;
  std::vector<std::pair<std::size_t, const EventRule*>> active_events_;
  std::vector<std::uint32_t> first_memory_;  ///< of each block with memories that events set
  std::map<std::pair<std::size_t, std::string>, std::uint32_t> switch_index_, table_index_;
  std::vector<PendingSwitch> pending_switches_;
  std::vector<PendingTable> pending_tables_;
  Network network_;
  std::vector<Quantity> quantities_;
  std::vector<std::uint32_t> first_quantity_;
  Diagnostics diagnostics_;
};

}  // namespace

Network assemble(const FlatDiagram& diagram) {
  return Assembler(diagram).assemble();
}

}  // namespace oblique
