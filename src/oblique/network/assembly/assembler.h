// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <oblique/network/assembly/network.h>
#include <oblique/network/graph/dependency_order.h>
#include <oblique/network/graph/expression_builder.h>
#include <oblique/network/program/tangents.h>

// How `assemble` works; not installed. network.cpp holds what is continuous, event_assembly.cpp what
// switches.
namespace oblique::network {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A quantity that some block's equation defines.
struct Quantity {
  std::size_t block;
  const diagram::Equation* equation;
  std::uint32_t variable_index = kNone;  ///< of the state or unknown
  NodeId node = kNone;                   ///< once known
};

/// One assembly: quantities are collected, ordered and defined one after the other; switches keep for later
/// what they compare, since nothing algebraic passes through them.
class Assembler {
 public:
  explicit Assembler(const diagram::FlatDiagram& diagram) : diagram_(diagram) {}
  Network assemble();

 private:
  struct PendingSwitch {
    std::size_t block;
    text::Expression left, right;
    std::uint32_t memory;
    text::Place place;
    Turning turning;
  };
  struct PendingTable {
    std::size_t block;
    text::Expression x;
    std::uint32_t table, segment;
    text::Place place;
  };
  struct ModeLines {
    NodeId initial, operate, hold;
  };
  struct ModeLine {
    std::uint32_t memory;
    diagram::SignalRef signal;
    std::string group;
  };
  class BlockContext;

  const diagram::FlatBlock& block_of(const Quantity& quantity) const;
  std::string name_of(const Quantity& quantity) const;
  std::uint32_t quantity_of(std::size_t block, std::string_view target) const;
  std::uint32_t quantity_of(diagram::SignalRef signal) const;
  void collect_quantities();
  void make_states();
  const diagram::StartRule& start_of(const Quantity& quantity) const;
  double start_value(const Quantity& quantity, const diagram::StartRule& rule);
  static std::optional<double> constant_of(const diagram::FlatBlock& block, std::string_view name);
  std::optional<double> constant_value(std::size_t block, const text::Expression& expression);
  std::uint32_t new_memory(std::string name, double start);
  void make_modes();
  void define_mode_lines();
  void define_phase_ends();
  void add_switch(Switch made);
  std::optional<NodeId> mode_node(std::size_t block, std::string_view name) const;
  void find_active_events();
  void make_memories();
  NodeId memory_node(std::size_t block, std::size_t memory);
  void make_events();
  std::vector<Event::Action> actions_of(std::size_t block, const std::vector<diagram::EventAction>& rules);
  void make_starts();
  void define_switches();
  std::optional<NodeId> rate_of(NodeId surface);
  bool follows_time_alone(NodeId id);
  NodeId switch_of(std::size_t block, const text::Expression& left, const text::Expression& right,
                   Turning turning);
  NodeId built(std::size_t block, const text::Expression& expression, const text::Place& place,
               const std::string& what);
  bool is_algebraic(std::uint32_t q) const;
  std::vector<bool> implicit_marks() const;
  Dependencies dependencies_of_algebra() const;
  void collect_needed(std::size_t block, const text::Expression& e, std::vector<std::uint32_t>& row) const;
  void define(const OrderStep& step);
  void name_members(const OrderStep& step, Loop& loop) const;
  NodeId finite(const Quantity& quantity, NodeId node);
  void collect_signals();
  NodeId expression_of(const Quantity& quantity);
  NodeId node_of(std::size_t block, std::string_view name);
  NodeId sum_of(const diagram::FlatInput& input);
  NodeId interpolated(std::size_t block, const text::Expression& call);
  NodeId interpolate(std::size_t block, const text::Expression& call, text::PointTable table);
  NodeId interpolate_by_segments(std::size_t block, const text::Expression& call, text::PointTable table);
  NodeId built_operand(std::size_t block, const text::Expression& expression);
  void define_tables();

  const diagram::FlatDiagram& diagram_;
  std::vector<ModeLines> modes_;  ///< of each group
  std::vector<ModeLine> mode_lines_;
  std::vector<std::pair<std::size_t, const diagram::EventRule*>> active_events_;
  std::vector<std::uint32_t> first_memory_;  ///< of each block with memories that events set
  std::map<std::pair<std::size_t, std::string>, std::uint32_t> switch_index_, table_index_;
  std::vector<PendingSwitch> pending_switches_;
  std::vector<PendingTable> pending_tables_;
  Network network_;
  std::vector<bool> beside_time_;  ///< of each node as far as looked at: what else varies is below it
  Tangents rates_by_time_{network_.graph, [this](std::uint32_t) { return network_.graph.constant(1); }};
  std::vector<Quantity> quantities_;
  std::vector<std::uint32_t> first_quantity_;
  text::Diagnostics diagnostics_;
};

/// The names of one block's equations.
class Assembler::BlockContext final : public ExpressionContext {
 public:
  BlockContext(Assembler& assembler, std::size_t block) : assembler_(assembler), block_(block) {}

  NodeId node_of_name(std::string_view name) override { return assembler_.node_of(block_, name); }

  Change change_of(std::string_view name) const override {
    const diagram::FlatBlock& flat = assembler_.diagram_.blocks[block_];
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

  NodeId greater(const text::Expression& left, const text::Expression& right, Turning turning) override {
    return assembler_.switch_of(block_, left, right, turning);
  }

  NodeId interpolated(const text::Expression& call) override { return assembler_.interpolated(block_, call); }

  double weights(const text::Expression& call) const override {
    const diagram::FlatBlock& flat = assembler_.diagram_.blocks[block_];
    const auto input = flat.definition->find_input(call.operands[0].name);
    if (!input)
      throw text::ExpressionError{call.column, "weights() takes an input", "the name of an input", {}};
    double sum = 0;
    for (const diagram::FlatTerm& term : flat.inputs[*input].terms) sum += std::abs(term.weight);
    return sum;
  }

 private:
  Assembler& assembler_;
  std::size_t block_;
};

}  // namespace oblique::network
