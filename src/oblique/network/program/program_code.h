// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <oblique/network/assembly/network.h>
#include <oblique/network/program/loop_solver.h>
#include <oblique/network/program/switch_structure.h>

namespace oblique::network {

/// Pattern of a square sparse matrix in compressed columns: rows ascending in each column, the diagonal
/// always there.
struct SparsePattern {
  std::vector<std::int64_t> column_starts{0};
  std::vector<std::int64_t> rows;

  std::size_t size() const { return column_starts.size() - 1; }
  std::size_t entries() const { return rows.size(); }
};

/// A part of the equations that follows the time alone, or clocks, and not along a straight line; or one that
/// follows states, and may be next to nothing here and a peak there, or is an event function that bends.
struct Source {
  std::uint32_t slot = 0, derivative_slot = 0;  ///< its value, and d value/dt (of one by states no use)
  bool acts = false;                            ///< on dx/dt, or on the event function of a switch
  bool by_states = false;
  std::optional<std::uint32_t> switch_index;  ///< the switch whose whole event function it is
  /// Of one by states what masks this switch, but no switch that is such a source itself: of two that mask
  /// each other both are looked at.
  std::vector<Mask> masks;
  bool on_branch = false;  ///< acts on an algebraic loop that is not linear: its solution may end or leap
};

/// What a Program consists of: the tape, and where on it and on its slots everything stands. Compilation
/// makes it, and Program and Evaluation read it.
struct ProgramCode {
  /// A segment of the tape, then perhaps a loop to solve.
  struct Step {
    TapeRange segment;
    std::optional<std::uint32_t> loop;
  };

  /// A derivative of a residual or of dx/dt by an unknown of a loop: where it enters the sums over dz/dx.
  struct Coupling {
    std::uint32_t loop;
    std::vector<MatrixEntry> entries;  ///< row of the target, unknown within `loop`, slot
    std::vector<std::uint32_t>
        targets;  ///< for a residual: column of the target for each column of dz/dx of `loop`
  };

  /// dz/dx of a loop: on which states it depends and what that is made of.
  struct Sensitivity {
    std::vector<std::uint32_t> states;  ///< columns of dz/dx
    std::vector<MatrixEntry> direct;    ///< dg/dx: row, column in `states`, slot
    std::vector<Coupling> couplings;    ///< dg/dz of loops solved earlier
  };

  struct DirectEntry {
    std::uint32_t position, slot;
  };
  /// One row of f_z: entry k of dz/dx's columns goes to `positions[k]` of the Jacobian.
  struct RowCoupling {
    std::uint32_t row, loop, unknown, slot;
    std::uint32_t first_position;  ///< in `row_positions`
  };

  /// A segment of the tape, then perhaps d unknowns/dt of a loop, from right sides that the segment has
  /// computed.
  struct RateStep {
    TapeRange segment;
    std::optional<std::uint32_t> loop;
    std::vector<std::uint32_t> right_sides, rates;  ///< slots
  };

  struct EventSlots {
    std::uint32_t condition = 0;
    std::vector<std::uint32_t> values;
  };

  /// A constant that follows from parameters, or is an operand of one that does.
  struct Constant {
    Op op = Op::constant;
    std::uint32_t a = 0, b = 0;  ///< constants, by their places in the list
    std::uint32_t parameter = ConstantFormula::kNoParameter;
    Decided decided = Decided::kind;  ///< where it does not stay, the program is another one
    double value = 0;                 ///< as compiled
    std::optional<std::uint32_t> slot;
  };

  struct OrderedSwitch {
    TapeRange segment;  ///< computes its event function and the rate of it
    std::uint32_t switch_index;
  };

  std::vector<State> states;
  std::vector<Unknown> unknowns;
  std::vector<Loop> loops;
  std::vector<std::string> signal_names;
  std::vector<std::size_t> first_signal;

  std::vector<Instruction> tape;
  std::vector<double> initial_slots;
  std::vector<Constant> constants;  ///< each after its operands
  std::size_t n_parameters = 0;
  std::vector<std::optional<std::uint32_t>> fixed_start_slots;  ///< of each state
  std::vector<LoopCode> loop_codes;
  std::vector<Step> derivative_steps;
  std::vector<Step> event_function_steps;  ///< after `derivative_steps`
  std::vector<Step> signal_steps;          ///< after `event_function_steps`
  TapeRange jacobian_segment;              ///< after `derivative_steps`
  std::vector<std::uint32_t> derivative_slots;
  std::vector<std::uint32_t> signal_slots;

  std::size_t first_discrete_state = 0;  ///< slot
  std::vector<DiscreteState> discrete_states;
  std::vector<Switch> switches;
  std::vector<Event> events;
  std::vector<std::uint32_t> mode_states;
  std::vector<std::uint32_t> event_function_slots;
  std::vector<std::uint32_t> compared_slots;  ///< one side of what the event function of each switch compares
  std::vector<std::optional<std::uint32_t>> rate_slots;
  std::vector<EventSlots> event_slots;
  std::vector<std::optional<std::uint32_t>> start_slots;
  std::vector<std::uint32_t> phase_end_slots;

  std::vector<OrderedSwitch> switch_order;
  std::vector<bool> is_ordered;                                              ///< of each switch
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> pieces;  ///< of each switch; slots
  std::vector<bool> has_pieces;  ///< of each switch: nothing but a choice between them reads its position

  SwitchStructure switch_structure;
  std::size_t first_rate = 0;        ///< slot of d states/dt, then of d unknowns/dt
  std::vector<RateStep> rate_steps;  ///< after `event_function_steps`
  std::vector<std::uint32_t> event_function_rate_slots, phase_rate_slots;
  std::vector<Source> sources;
  std::vector<std::size_t> source_states;
  std::size_t n_clocks = 0;
  TapeRange source_segment;
  /// How fast the arguments of all sines and cosines go that are the only bends of acting sources; nothing
  /// where there are other ones.
  std::optional<std::vector<std::uint32_t>> turning_rate_slots;

  SparsePattern pattern;
  std::vector<DirectEntry> direct_entries;
  /// ∂/∂t of dx/dt and of the residuals that derivatives need: row among states and unknowns, slot.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> time_entries;
  std::vector<Sensitivity> sensitivities;        ///< of each loop; empty for those no derivative needs
  std::vector<std::uint32_t> sensitivity_order;  ///< loops that derivatives need
  std::vector<RowCoupling> row_couplings;
  std::vector<std::uint32_t> row_positions;
};

}  // namespace oblique::network
