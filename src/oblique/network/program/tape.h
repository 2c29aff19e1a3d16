// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/graph/expression_graph.h>
#include <oblique/text/point_table.h>

namespace oblique::network {

/// One instruction of a tape: slots of the operands and of the result.
struct Instruction {
  enum class Code : std::uint32_t {
// the smooth operations
#define OBLIQUE_OPERATION(name, ...) name,
#include <oblique/text/operations.def>
    select,  ///< a ? b : c
    gate,
    less,
    less_equal,
    equal,
    table_value,  ///< of the tables, the last operand is the slot where the table begins
    table_slope,
    table_end,
    table_begin,
    table_segment,
    multiply_add,       ///< a·b + c
    multiply_subtract,  ///< c − a·b
  };
  Code code;
  std::uint32_t a, b, c;
  std::uint32_t result;
};

/// How many operands an instruction has.
int operand_count(Instruction::Code code);

/// A segment of instructions, half open.
struct TapeRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// Runs instructions over `slots`; never allocates.
void run_tape(std::span<const Instruction> instructions, double* slots);

/// Turns graph nodes into instructions and gives every value a slot.
class TapeWriter {
 public:
  /// `uses` counts, for every node, who reads it: the nodes to be written and the world outside. The first
  /// `n_variables` slots are the variables, by their number.
  /// Discrete states have the slots after the variables.
  TapeWriter(const ExpressionGraph& graph, std::size_t n_variables, std::size_t n_discrete_states,
             const std::vector<text::PointTable>& tables, std::vector<std::uint32_t> uses);

  /// Appends the instructions of `nodes` (ascending; their operands are constants, variables, among them, or
  /// written before). A product that nobody but one sum in the same segment reads becomes one instruction
  /// with it.
  TapeRange write(std::span<const NodeId> nodes);

  /// The slot of a node, made on first request.
  std::uint32_t slot(NodeId id);
  /// The slot of a node that was asked for.
  std::optional<std::uint32_t> known_slot(NodeId id) const;

  const std::vector<Instruction>& instructions() const { return instructions_; }
  /// What every slot holds before the first instruction: the constants in their places, zeros elsewhere.
  const std::vector<double>& initial_slots() const { return initial_slots_; }

 private:
  bool can_fuse(NodeId id) const;

  std::uint32_t operand_slot(const Node& node, int operand);

  const ExpressionGraph* graph_;
  std::size_t n_variables_;
  std::vector<std::uint32_t> table_slots_;
  std::vector<std::uint32_t> uses_;
  std::vector<std::uint32_t> slots_;
  std::vector<std::uint32_t> segment_;  ///< number of the segment that last contained the node
  std::vector<std::uint32_t> fused_;    ///< number of the segment in which the product went into its sum
  std::uint32_t current_segment_ = 0;
  std::vector<Instruction> instructions_;
  std::vector<double> initial_slots_;
};

}  // namespace oblique::network
