// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <oblique/network/assembly/network.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/tangents.h>

namespace oblique::network {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A quantity that some block's equation defines.
struct Quantity {
  std::size_t block;
  const diagram::Equation* equation;
  std::uint32_t variable_index = kNone;  ///< of the state or unknown
  NodeId node = kNone;                   ///< once known
};

/// A network in the making: quantities are collected, ordered and defined one after the other; switches keep
/// for later what they compare, since nothing algebraic passes through them. What it is made of the other
/// units of this room add.
struct Assembly {
  explicit Assembly(const diagram::FlatDiagram& flat) : diagram(flat), numbers(flat) {}

  struct PendingSwitch {
    std::size_t block;
    text::Expression left, right;
    std::uint32_t discrete_state;
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
    std::uint32_t discrete_state;
    diagram::SignalRef signal;
    std::string group;
  };

  const diagram::FlatBlock& block_of(const Quantity& quantity) const;
  std::string name_of(const Quantity& quantity) const;
  /// The quantity that an equation of a block defines; kNone where none does.
  std::uint32_t quantity_of(std::size_t block, std::string_view target) const;
  std::uint32_t quantity_of(diagram::SignalRef signal) const;
  const diagram::StartRule& start_of(const Quantity& quantity) const;

  std::uint32_t new_discrete_state(std::string name, double start);
  /// Whether an expression never changes.
  bool is_constant(std::size_t block, const text::Expression& expression);
  /// Its value, by which something is decided; nothing for one that changes.
  std::optional<double> constant_value(std::size_t block, const text::Expression& expression);
  /// Has the conditions decide by which blocks have chosen the cases of their equations: with held
  /// parameters, which change when all is built.
  void decide_cases();
  /// The weight of a wire at an input.
  NodeId weight(std::size_t block, std::size_t input, std::size_t wire);
  /// What a name in a block's equations stands for.
  NodeId node_of(std::size_t block, std::string_view name);
  /// The node of an expression of a block. What is wrong in it becomes a diagnostic, which says that it is
  /// `what` of the block.
  NodeId built(std::size_t block, const text::Expression& expression, const text::Place& place,
               const std::string& what);
  /// The same within an expression that is being built. Throws text::ExpressionError.
  NodeId built_operand(std::size_t block, const text::Expression& expression);

  const diagram::FlatDiagram& diagram;
  ParameterNumbers numbers;
  std::vector<ModeLines> modes;  ///< of each group
  std::vector<ModeLine> mode_lines;
  std::vector<std::pair<std::size_t, const diagram::EventRule*>> active_events;
  std::vector<std::uint32_t> first_discrete_state;  ///< of each block with discrete states that events set
  std::map<std::pair<std::size_t, std::string>, std::uint32_t> switch_index, table_index;
  std::vector<PendingSwitch> pending_switches;
  std::vector<PendingTable> pending_tables;
  Network network;
  std::vector<bool> beside_time;  ///< of each node as far as looked at: what else varies is below it
  Tangents rates_by_time{network.graph, [this](std::uint32_t) { return network.graph.constant(1); }};
  std::vector<Quantity> quantities;
  std::vector<std::uint32_t> first_quantity;
  text::Diagnostics diagnostics;
};

}  // namespace oblique::network
